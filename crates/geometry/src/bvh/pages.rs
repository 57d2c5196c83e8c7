//! Memory in large pages. A ray through a large tree touches a few dozen nodes far apart, and with pages of 4 KiB most of
//! them miss the processor's table of pages; with pages of 2 MiB few do. Linux gives such pages on advice.

#![allow(unsafe_code, reason = "advice on memory is given by a system call")]

/// Arrays below this size hold no whole page.
const WORTH_BYTES: usize = 2 << 20;

/// An empty array for so many values, in large pages where it is large and the system has them.
pub(crate) fn vec_in_large_pages<T>(capacity: usize) -> Vec<T> {
    let memory = Vec::with_capacity(capacity);
    if size_of::<T>().saturating_mul(capacity) >= WORTH_BYTES {
        advise_large_pages(&memory);
    }
    memory
}

#[cfg(target_os = "linux")]
fn advise_large_pages<T>(memory: &Vec<T>) {
    use std::ffi::{c_int, c_void};

    const PAGE: usize = 1 << 12;
    const MADV_HUGEPAGE: c_int = 14;

    unsafe extern "C" {
        fn madvise(address: *mut c_void, length: usize, advice: c_int) -> c_int;
    }

    let start = memory.as_ptr() as usize;
    let end = start + size_of::<T>() * memory.capacity();
    let first_page = start.next_multiple_of(PAGE);
    let length = (end - end % PAGE).saturating_sub(first_page);
    let address = memory.as_ptr().cast::<u8>().wrapping_add(first_page - start).cast_mut();
    // SAFETY: the pages lie within one living allocation, and the advice changes how the system backs them, not what
    // they hold. It may be refused, which changes nothing.
    unsafe {
        madvise(address.cast(), length, MADV_HUGEPAGE);
    }
}

#[cfg(not(target_os = "linux"))]
fn advise_large_pages<T>(_: &Vec<T>) {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Advice changes nothing that a program can see: the values are those of an ordinary array.
    #[test]
    fn memory_in_large_pages_is_memory() {
        for n in [0, 1, 1000, (WORTH_BYTES / 8) + 77] {
            let mut values = vec_in_large_pages::<u64>(n);
            assert!(values.is_empty() && values.capacity() >= n);
            let address = values.as_ptr();
            values.extend((0..n as u64).map(|i| i * i));
            assert_eq!(values.as_ptr(), address, "it is not moved");
            assert!(values.iter().enumerate().all(|(i, v)| *v == (i * i) as u64));
        }
    }
}
