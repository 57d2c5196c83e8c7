//! Points, vectors and normals as different types: a transform treats each in its own way, and the compiler
//! then finds a normal used as a direction.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

macro_rules! tuple_type {
    ($(#[$doc:meta])* $name:ident { $($field:ident = $index:literal),+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $name {
            $(
                #[allow(missing_docs, reason = "the coordinate of that name")]
                pub $field: f32,
            )+
        }

        impl $name {
            /// From coordinates.
            #[inline]
            #[must_use]
            pub const fn new($($field: f32),+) -> Self {
                Self { $($field),+ }
            }

            /// All coordinates equal.
            #[inline]
            #[must_use]
            pub const fn splat(value: f32) -> Self {
                Self { $($field: value),+ }
            }

            /// Coordinate by coordinate minimum.
            #[inline]
            #[must_use]
            pub fn min(self, other: Self) -> Self {
                Self { $($field: self.$field.min(other.$field)),+ }
            }

            /// Coordinate by coordinate maximum.
            #[inline]
            #[must_use]
            pub fn max(self, other: Self) -> Self {
                Self { $($field: self.$field.max(other.$field)),+ }
            }

            /// Coordinate by coordinate absolute value.
            #[inline]
            #[must_use]
            pub fn abs(self) -> Self {
                Self { $($field: self.$field.abs()),+ }
            }

            /// The largest coordinate.
            #[inline]
            #[must_use]
            pub fn max_element(self) -> f32 {
                let mut result = f32::NEG_INFINITY;
                $( result = result.max(self.$field); )+
                result
            }

            /// True if no coordinate is NaN or infinite.
            #[inline]
            #[must_use]
            pub fn is_finite(self) -> bool {
                $( self.$field.is_finite() )&&+
            }

            /// `self` at `t = 0`, `other` at `t = 1`.
            #[inline]
            #[must_use]
            pub fn lerp(self, other: Self, t: f32) -> Self {
                Self { $($field: (1.0 - t) * self.$field + t * other.$field),+ }
            }
        }

        impl Index<usize> for $name {
            type Output = f32;
            #[inline]
            fn index(&self, index: usize) -> &f32 {
                match index {
                    $( $index => &self.$field, )+
                    _ => panic!("coordinate index {index} out of range"),
                }
            }
        }

        impl IndexMut<usize> for $name {
            #[inline]
            fn index_mut(&mut self, index: usize) -> &mut f32 {
                match index {
                    $( $index => &mut self.$field, )+
                    _ => panic!("coordinate index {index} out of range"),
                }
            }
        }
    };
}

/// `$a op $b = $out`, coordinate by coordinate.
macro_rules! tuple_operator {
    ($trait:ident $method:ident $op:tt : $a:ident, $b:ident => $out:ident { $($field:ident),+ }) => {
        impl $trait<$b> for $a {
            type Output = $out;
            #[inline]
            fn $method(self, other: $b) -> $out {
                $out { $($field: self.$field $op other.$field),+ }
            }
        }
    };
}

/// Scaling, negation and the assigning operators of a vector space.
macro_rules! vector_space {
    ($name:ident { $($field:ident),+ }) => {
        tuple_operator!(Add add + : $name, $name => $name { $($field),+ });
        tuple_operator!(Sub sub - : $name, $name => $name { $($field),+ });
        impl AddAssign for $name {
            #[inline]
            fn add_assign(&mut self, other: Self) { $( self.$field += other.$field; )+ }
        }
        impl SubAssign for $name {
            #[inline]
            fn sub_assign(&mut self, other: Self) { $( self.$field -= other.$field; )+ }
        }
        impl Neg for $name {
            type Output = Self;
            #[inline]
            fn neg(self) -> Self { Self { $($field: -self.$field),+ } }
        }
        impl Mul<f32> for $name {
            type Output = Self;
            #[inline]
            fn mul(self, s: f32) -> Self { Self { $($field: self.$field * s),+ } }
        }
        impl Mul<$name> for f32 {
            type Output = $name;
            #[inline]
            fn mul(self, v: $name) -> $name { v * self }
        }
        impl MulAssign<f32> for $name {
            #[inline]
            fn mul_assign(&mut self, s: f32) { $( self.$field *= s; )+ }
        }
        impl Div<f32> for $name {
            type Output = Self;
            #[inline]
            fn div(self, s: f32) -> Self { Self { $($field: self.$field / s),+ } }
        }

        impl $name {
            /// Squared length.
            #[inline]
            #[must_use]
            pub fn length_squared(self) -> f32 {
                let mut sum = 0.0;
                $( sum += self.$field * self.$field; )+
                sum
            }

            /// Length.
            #[inline]
            #[must_use]
            pub fn length(self) -> f32 {
                self.length_squared().sqrt()
            }

            /// The vector of length 1 in the same direction; not finite for the zero vector.
            #[inline]
            #[must_use]
            pub fn normalized(self) -> Self {
                self * (1.0 / self.length())
            }

            /// The vector of length 1 in the same direction, or `None` where there is no direction.
            #[inline]
            #[must_use]
            pub fn try_normalized(self) -> Option<Self> {
                let length = self.length();
                // A length above 0 is at least 3.7e-23, the root of the smallest number, and has a finite reciprocal.
                (length > 0.0 && length.is_finite()).then(|| self * (1.0 / length))
            }
        }
    };
}

tuple_type!(
    /// A point on a plane: pixel, texture coordinate or point of the unit square.
    Point2 { x = 0, y = 1 }
);
tuple_type!(
    /// A vector in the plane.
    Vector2 { x = 0, y = 1 }
);
tuple_type!(
    /// A position in space, in metres.
    Point3 { x = 0, y = 1, z = 2 }
);
tuple_type!(
    /// A direction or displacement in space.
    Vector3 { x = 0, y = 1, z = 2 }
);
tuple_type!(
    /// A surface normal: transformed by the inverse transpose.
    Normal3 { x = 0, y = 1, z = 2 }
);

vector_space!(Vector2 { x, y });
vector_space!(Vector3 { x, y, z });
vector_space!(Normal3 { x, y, z });
tuple_operator!(Sub sub - : Point2, Point2 => Vector2 { x, y });
tuple_operator!(Add add + : Point2, Vector2 => Point2 { x, y });
tuple_operator!(Sub sub - : Point2, Vector2 => Point2 { x, y });
tuple_operator!(Sub sub - : Point3, Point3 => Vector3 { x, y, z });
tuple_operator!(Add add + : Point3, Vector3 => Point3 { x, y, z });
tuple_operator!(Sub sub - : Point3, Vector3 => Point3 { x, y, z });

impl AddAssign<Vector3> for Point3 {
    #[inline]
    fn add_assign(&mut self, v: Vector3) {
        *self = *self + v;
    }
}

/// Dot products between vectors and normals, all with the same formula.
macro_rules! dot {
    ($a:ident, $b:ident, $dot:ident, $abs_dot:ident) => {
        impl $a {
            /// Dot product.
            #[inline]
            #[must_use]
            pub fn $dot(self, other: $b) -> f32 {
                self.x * other.x + self.y * other.y + self.z * other.z
            }

            /// Absolute value of the dot product.
            #[inline]
            #[must_use]
            pub fn $abs_dot(self, other: $b) -> f32 {
                self.$dot(other).abs()
            }
        }
    };
}
dot!(Vector3, Vector3, dot, abs_dot);
dot!(Vector3, Normal3, dot_normal, abs_dot_normal);
dot!(Normal3, Normal3, dot, abs_dot);
dot!(Normal3, Vector3, dot_vector, abs_dot_vector);

impl Vector2 {
    /// Dot product.
    #[inline]
    #[must_use]
    pub fn dot(self, other: Self) -> f32 {
        self.x * other.x + self.y * other.y
    }
}

impl Vector3 {
    /// Cross product. Products are formed in double precision: their difference may cancel.
    #[inline]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        let minor = |a: f32, b: f32, c: f32, d: f32| {
            (f64::from(a) * f64::from(b) - f64::from(c) * f64::from(d)) as f32
        };
        Self::new(
            minor(self.y, other.z, self.z, other.y),
            minor(self.z, other.x, self.x, other.z),
            minor(self.x, other.y, self.y, other.x),
        )
    }

    /// Angle between two unit vectors in radians, accurate also near 0 and pi.
    #[must_use]
    pub fn angle_between(self, other: Self) -> f32 {
        if self.dot(other) < 0.0 {
            std::f32::consts::PI - 2.0 * ((self + other).length() / 2.0).min(1.0).asin()
        } else {
            2.0 * ((other - self).length() / 2.0).min(1.0).asin()
        }
    }

    /// The same numbers as a normal.
    #[inline]
    #[must_use]
    pub const fn as_normal(self) -> Normal3 {
        Normal3::new(self.x, self.y, self.z)
    }

    /// Index of the coordinate of largest absolute value.
    #[inline]
    #[must_use]
    pub fn max_dimension(self) -> usize {
        let a = self.abs();
        if a.x > a.y {
            if a.x > a.z { 0 } else { 2 }
        } else if a.y > a.z {
            1
        } else {
            2
        }
    }
}

impl Normal3 {
    /// The same numbers as a vector.
    #[inline]
    #[must_use]
    pub const fn as_vector(self) -> Vector3 {
        Vector3::new(self.x, self.y, self.z)
    }

    /// This normal or its opposite, whichever lies in the hemisphere of `v`.
    #[inline]
    #[must_use]
    pub fn facing(self, v: Vector3) -> Self {
        if self.dot_vector(v) < 0.0 { -self } else { self }
    }
}

impl Point3 {
    /// The origin.
    pub const ORIGIN: Self = Self::splat(0.0);

    /// Distance between two points.
    #[inline]
    #[must_use]
    pub fn distance(self, other: Self) -> f32 {
        (self - other).length()
    }

    /// Squared distance between two points.
    #[inline]
    #[must_use]
    pub fn distance_squared(self, other: Self) -> f32 {
        (self - other).length_squared()
    }

    /// The vector from the origin to this point.
    #[inline]
    #[must_use]
    pub const fn as_vector(self) -> Vector3 {
        Vector3::new(self.x, self.y, self.z)
    }
}
