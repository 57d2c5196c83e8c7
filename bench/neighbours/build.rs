//! Compiles the wrapper of nanoflann.

fn main() {
    println!("cargo:rerun-if-changed=src/nanoflann.cpp");
    cc::Build::new().cpp(true).std("c++17").opt_level(3).file("src/nanoflann.cpp").compile("nanoflann_wrapper");
}
