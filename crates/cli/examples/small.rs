//! A path tracer that fits on a few pages: a room, three balls, a lamp (SPEC SMALL-1 to SMALL-10).
//!
//! A path goes from the eye, bounce by bounce, with the share of light that it would bring along, until it finds the lamp; the
//! mean of many paths is the picture (Kajiya 1986). After the "smallpaint" program of a lecture (K. Zsolnai-Fehér, TU Wien),
//! without its errors; `--as-printed` has them all. `--first` is the first scene, whose tiny lamp hardly any path finds.
//!
//! `small [--as-printed] [--first] [--size PIXELS] [--samples N] [--threads N] [--out FILE.ppm]`
#![expect(clippy::print_stderr, reason = "a program of one file talks for itself")]

#[cfg(test)]
#[path = "small/tests.rs"]
mod tests;
/// A point, a direction or a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
struct V(f64, f64, f64);
#[rustfmt::skip]
impl V {
    fn dot(self, b: V) -> f64 { self.0 * b.0 + self.1 * b.1 + self.2 * b.2 }
    fn cross(self, b: V) -> V { V(self.1 * b.2 - self.2 * b.1, self.2 * b.0 - self.0 * b.2, self.0 * b.1 - self.1 * b.0) }
    fn normalized(self) -> V { self * (1.0 / self.dot(self).sqrt()) }
}
#[rustfmt::skip]
mod operators {
    use super::V;
    impl std::ops::Add for V { type Output = V; fn add(self, b: V) -> V { V(self.0 + b.0, self.1 + b.1, self.2 + b.2) } }
    impl std::ops::Sub for V { type Output = V; fn sub(self, b: V) -> V { V(self.0 - b.0, self.1 - b.1, self.2 - b.2) } }
    impl std::ops::Mul for V { type Output = V; fn mul(self, b: V) -> V { V(self.0 * b.0, self.1 * b.1, self.2 * b.2) } }
    impl std::ops::Mul<f64> for V { type Output = V; fn mul(self, s: f64) -> V { V(self.0 * s, self.1 * s, self.2 * s) } }
}

/// Origin and direction, which has length 1 but for diffuse bounces as printed.
#[derive(Clone, Copy, Debug)]
struct Ray(V, V);
/// A sphere has centre and radius; a plane has unit normal n and D, where n·p + D = 0.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Sphere(V, f64),
    Plane(V, f64),
}
/// What is diffuse has ten times its albedo, a lamp has its radiance and is black.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Diffuse(V),
    Mirror,
    Glass,
    Lamp(f64),
}
#[derive(Clone, Copy, Debug)]
struct Object(Shape, Kind);

impl Object {
    /// Where a ray meets it. What is nearer than 1e-4 is the surface that the ray leaves.
    fn intersect(&self, Ray(o, d): &Ray) -> Option<f64> {
        let is_ahead = |t: &f64| *t > 1e-4;
        match self.0 {
            Shape::Plane(n, offset) => Some(-(n.dot(*o) + offset) / n.dot(*d)).filter(is_ahead),
            Shape::Sphere(centre, radius) => {
                // t² + b t + c = 0, whose roots are (-b ± √(b² - 4c)) / 2.
                let oc = *o - centre;
                let (b, c) = (2.0 * oc.dot(*d), oc.dot(oc) - radius * radius);
                let root = Some(b * b - 4.0 * c).filter(|disc| *disc >= 0.0)?.sqrt();
                [(-b - root) / 2.0, (-b + root) / 2.0].into_iter().find(is_ahead)
            }
        }
    }
    fn normal(&self, p: V) -> V {
        match self.0 {
            Shape::Plane(n, _) => n,
            Shape::Sphere(centre, radius) => (p - centre) * (1.0 / radius),
        }
    }
}

/// Random numbers in [0, 1) (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The digits of a number in reverse behind the point: Halton's sequence (1960), which fills [0, 1) evenly.
fn radical_inverse(base: u64, index: u64) -> f64 {
    if index == 0 { 0.0 } else { ((index % base) as f64 + radical_inverse(base, index / base)) / base as f64 }
}

/// Two numbers for a bounce, even over the samples of a pixel; random shifts keep depths apart (Cranley and Patterson 1976).
fn halton_pair([pixel, sample]: [u64; 2], depth: u64) -> [f64; 2] {
    let mut random = Random(pixel << 20 ^ depth << 52);
    let index = sample + (1e6 * random.next()) as u64;
    [2, 3].map(|base| (radical_inverse(base, index) + random.next()).fract())
}

/// A direction whose cosine to the pole is z, at a share of the circle around it.
fn direction(z: f64, turn: f64) -> V {
    let (r, phi) = ((1.0 - z * z).max(0.0).sqrt(), std::f64::consts::TAU * turn);
    V(r * phi.cos(), r * phi.sin(), z)
}

/// In proportion to the cosine around n.
fn cosine_lobe(n: V, [u, v]: [f64; 2]) -> V {
    let across = n.cross(if n.0.abs() > 0.5 { V(0.0, 1.0, 0.0) } else { V(1.0, 0.0, 0.0) }).normalized();
    let V(x, y, z) = direction(u.sqrt(), v);
    across * x + n.cross(across) * y + n * z
}

/// Through glass or off it, as a random number chooses. As printed, Schlick's cosine inside is taken for that outside.
fn refract(d: V, n: V, ior: f64, choice: f64, as_printed: bool) -> V {
    let is_inside = n.dot(d) > 0.0;
    let (n, ratio) = if is_inside { (n * -1.0, ior) } else { (n, 1.0 / ior) };
    let cosine = -n.dot(d);
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    let outside = if is_inside && !as_printed { squared.max(0.0).sqrt() } else { cosine };
    let r0 = ((1.0 - ior) / (1.0 + ior)).powi(2);
    let reflectance = r0 + (1.0 - r0) * (1.0 - outside).powi(5);
    let through = || d * ratio + n * (ratio * cosine - squared.sqrt());
    if squared > 0.0 && choice > reflectance { through() } else { d + n * (2.0 * cosine) }.normalized()
}

/// The room, and how light is followed in it.
struct Program {
    objects: Vec<Object>,
    ior: f64,
    /// What becomes white is 1 / exposure.
    exposure: f64,
    /// From right, down and towards the eye to the axes of the scene: in the first version, x points down.
    axes: fn(f64, f64, f64) -> V,
    as_printed: bool,
}

impl Program {
    fn new(first: bool, as_printed: bool) -> Self {
        let axes = if first { |r, d, z| V(d, r, z) } else { |r, d: f64, z| V(r, -d, z) };
        let diffuse = |r, g, b| Kind::Diffuse(V(r, g, b));
        let grey = diffuse(6.0, 6.0, 6.0);
        let wall = |d, [r, down, z]: [f64; 3], kind| Object(Shape::Plane(axes(r, down, z), d), kind);
        let ball = |r, centre, kind| Object(Shape::Sphere(centre, r), kind);
        let [middle, left, right, top] = if first {
            [V(1.45, -0.75, -4.4), V(1.95, -1.75, -3.1), V(2.05, 0.8, -3.7), V(-1.9, 0.0, -3.0)]
        } else {
            [V(-0.75, -1.45, -4.4), V(-1.75, -1.95, -3.1), V(2.0, -2.05, -3.7), V(0.0, 1.9, -3.0)]
        };
        let (right_radius, ior) = if first { (0.45, 1.9) } else { (0.5, 1.5) };
        let (lamp_radius, lamp, exposure) = if first { (1e-4, 120.0, 4e6) } else { (0.5, 1e4, 0.002) };
        let objects = vec![
            wall(2.5, [0.0, -1.0, 0.0], grey),
            wall(3.0, [0.0, 1.0, 0.0], grey),
            wall(5.5, [0.0, 0.0, 1.0], grey),
            wall(0.5, [0.0, 0.0, -1.0], grey),
            wall(2.75, [1.0, 0.0, 0.0], diffuse(10.0, 2.0, 2.0)),
            wall(2.75, [-1.0, 0.0, 0.0], diffuse(2.0, 10.0, 2.0)),
            ball(1.05, middle, Kind::Mirror),
            ball(0.6, left, diffuse(4.0, 4.0, 12.0)),
            ball(right_radius, right, Kind::Glass),
            ball(lamp_radius, top, Kind::Lamp(lamp)),
        ];
        Self { objects, ior, exposure, axes, as_printed }
    }
    /// With which probability a path ends. As printed it surely does at depth 16, and what would follow is lost.
    fn stop_probability(&self, depth: u64) -> f64 {
        let late = if self.as_printed { (0.0625 * depth as f64).min(1.0) } else { 0.25 };
        if depth < 5 { 0.0 } else { late }
    }
    fn nearest(&self, ray: &Ray) -> Option<(f64, &Object)> {
        let hits = self.objects.iter().filter_map(|object| Some((object.intersect(ray)?, object)));
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }
    /// The light that one path finds.
    fn trace(&self, mut ray: Ray, path: [u64; 2], random: &mut Random) -> V {
        let mut share = V(1.0, 1.0, 1.0);
        for depth in 0.. {
            let stop = self.stop_probability(depth);
            if random.next() < stop {
                break;
            }
            share = share * (1.0 / (1.0 - stop));
            let Some((t, object)) = self.nearest(&ray) else { break };
            let (p, d) = (ray.0 + ray.1 * t, ray.1);
            let n = object.normal(p);
            let bounced = match object.1 {
                Kind::Lamp(radiance) => return share * radiance * if self.as_printed { 2.0 } else { 1.0 },
                Kind::Diffuse(colour) if self.as_printed => {
                    // One number twice, around the z axis of the world, and of any length up to 2.
                    let u = radical_inverse(2, (path[0] * 64 + path[1]) * 16 + depth);
                    share = share * colour * (0.1 * (n + direction(u, u)).dot(n));
                    n + direction(u, u)
                }
                Kind::Diffuse(V(r, g, b)) => {
                    share = share * V((0.1 * r).min(1.0), (0.1 * g).min(1.0), (0.1 * b).min(1.0));
                    cosine_lobe(if n.dot(d) < 0.0 { n } else { n * -1.0 }, halton_pair(path, depth))
                }
                Kind::Mirror => d - n * (2.0 * n.dot(d)),
                Kind::Glass => {
                    share = share * if self.as_printed { 1.15 } else { 1.0 };
                    refract(d, n, self.ior, random.next(), self.as_printed)
                }
            };
            ray = Ray(p, bounced);
        }
        V(0.0, 0.0, 0.0)
    }
    /// The eye, at the origin, sees 90 degrees: a pixel is 2 / size wide at distance 1. As printed, pixels are off and overlap.
    fn pixel(&self, [x, y]: [usize; 2], size: usize, n_samples: u64) -> V {
        let (pixel, mut random) = ((y * size + x) as u64, Random(!((y * size + x) as u64) << 20));
        let (middle, width) = if self.as_printed { (0.0, 2.0 / 700.0) } else { (1.0, 2.0 / size as f64) };
        let paths = (0..n_samples).map(|sample| {
            let mut place = |i| (2.0 * i as f64 + middle) / size as f64 - 1.0 + (random.next() - 0.5) * width;
            let ray = Ray(V(0.0, 0.0, 0.0), (self.axes)(place(x), place(y), -1.0).normalized());
            self.trace(ray, [pixel, sample], &mut random)
        });
        paths.fold(V(0.0, 0.0, 0.0), |sum, light| sum + light) * (1.0 / n_samples as f64)
    }
    /// A file of text (PPM). As printed, radiance itself; else encoded for screens.
    fn encode(&self, pixels: &[V], size: usize) -> String {
        let encoded = |x: f64| if self.as_printed { x } else { 255.0 * (self.exposure * x).powf(0.4545) };
        let byte = |x: f64| format!("{}\n", encoded(x).min(255.0) as u8);
        let bytes = pixels.iter().flat_map(|V(r, g, b)| [byte(*r), byte(*g), byte(*b)]);
        format!("P3 {size} {size} 255\n") + &bytes.collect::<String>()
    }
}

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| arguments.iter().skip_while(|a| *a != name).nth(1);
    let number = |name, default| {
        value(name).and_then(|v| v.parse().ok()).map_or(default, |n: usize| n.clamp(1, 10_000))
    };
    let is_given = |name: &str| arguments.iter().any(|a| a == name);
    let program = Program::new(is_given("--first"), is_given("--as-printed"));
    let (size, n_samples) = (number("--size", 900), number("--samples", 64) as u64);
    let n_threads = number("--threads", std::thread::available_parallelism().map_or(1, usize::from));
    let started = std::time::Instant::now();
    let mut pixels = vec![V(0.0, 0.0, 0.0); size * size];
    let rows = std::sync::Mutex::new(pixels.chunks_mut(size).enumerate());
    let work = || {
        while let Some((y, row)) = rows.lock().ok().and_then(|mut rows| rows.next()) {
            row.iter_mut().enumerate().for_each(|(x, p)| *p = program.pixel([x, y], size, n_samples));
            eprint!("\r{:3} %", 100 * (y + 1) / size);
        }
    };
    std::thread::scope(|scope| (0..n_threads).for_each(|_| drop(scope.spawn(work))));
    let mean = pixels.iter().fold(V(0.0, 0.0, 0.0), |sum, p| sum + *p) * (1.0 / pixels.len() as f64);
    eprintln!("\r{:.1} s, mean radiance {mean:.2?}", started.elapsed().as_secs_f64());
    std::fs::write(value("--out").map_or("small.ppm", String::as_str), program.encode(&pixels, size))
}
