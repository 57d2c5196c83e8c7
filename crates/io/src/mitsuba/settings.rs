//! Sensor, film, sampler, filter and integrator.

use etendue_scene::Span;
use etendue_scene::document::{CameraEntity, Entity, Value};

use super::element::Element;
use super::emitters::mirrored;
use super::reader::{Reader, entity, parameter};

/// Mitsuba's integrators with what stands for them here.
const INTEGRATORS: &[(&str, &str)] = &[
    ("path", "path"),
    ("direct", "path"),
    ("volpath", "volpath"),
    ("volpathmis", "volpath"),
    ("volpath_simple", "simplevolpath"),
    ("prb", "path"),
    ("prb_basic", "path"),
    ("prb_projective", "path"),
    ("prbvolpath", "volpath"),
    ("ao", "ambientocclusion"),
    ("ptracer", "lightpath"),
    ("bdpt", "bdpt"),
    ("mlt", "mlt"),
    ("pssmlt", "mlt"),
    ("erpt", "mlt"),
    ("ppm", "sppm"),
    ("sppm", "sppm"),
    ("photonmapper", "sppm"),
];
/// Integrators that only show one thing or another.
const MISSING_INTEGRATORS: &[&str] =
    &["depth", "vpl", "field", "stokes", "velocity", "direct_projective", "specfilm"];
/// Integrators around others.
const AROUND_OTHERS: &[&str] = &["moment", "aov", "adaptive", "irrcache", "multichannel", "motion"];

/// Scattering events of paths whose length Mitsuba does not limit; roulette ends them earlier.
const UNLIMITED_DEPTH: i32 = 1000;

const FILTERS: &[&str] = &["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"];
const SAMPLERS: &[(&str, &str)] = &[
    ("independent", "independent"),
    ("stratified", "stratified"),
    ("multijitter", "stratified"),
    ("orthogonal", "paddedsobol"),
    ("ldsampler", "paddedsobol"),
    ("halton", "halton"),
    ("hammersley", "halton"),
    ("sobol", "sobol"),
];
const SENSORS: &[&str] = &["perspective", "thinlens", "orthographic"];
const MISSING_SENSORS: &[&str] = &[
    "batch",
    "distant",
    "irradiancemeter",
    "radiancemeter",
    "fluencemeter",
    "perspective_rdist",
    "spherical",
    "telecentric",
    "distantflux",
];

impl<'e> Reader<'e> {
    pub(super) fn sensor(&mut self, sensor: &'e Element) {
        let resolution = match self.nested(sensor, "film").first() {
            Some(film) => self.film(film),
            None => self.default_film(sensor),
        };
        if let Some(sampler) = self.nested(sensor, "sampler").first().copied() {
            self.sampler(sampler);
        }
        let to_world = self.transform(sensor, "to_world");
        let mut camera = match sensor.plugin() {
            "perspective" | "thinlens" => {
                let mut camera = entity("perspective", sensor);
                self.field_of_view(sensor, resolution, &mut camera);
                camera
            }
            // Its window is [-1, 1] across, whatever the height.
            "orthographic" => {
                let aspect = resolution[0] as f32 / resolution[1] as f32;
                let (x, y) = (1.0, 1.0 / aspect);
                entity("orthographic", sensor).with("screenwindow", Value::Floats(vec![-x, x, -y, y]))
            }
            "spherical" => entity("spherical", sensor).with("mapping", strings("equirectangular")),
            _ => {
                self.unknown_plugin(
                    sensor,
                    MISSING_SENSORS,
                    SENSORS,
                    "a `perspective` camera stands in for it",
                );
                entity("perspective", sensor)
            }
        };
        if sensor.plugin() == "thinlens" {
            self.pass_number(sensor, "aperture_radius", &mut camera, "lensradius");
            self.pass_number(sensor, "focus_distance", &mut camera, "focaldistance");
        }
        let open = self.float(sensor, "shutter_open", 0.0);
        let close = self.float(sensor, "shutter_close", open);
        if to_world.is_animated() || close > open {
            camera = camera.with("shutteropen", Value::Floats(vec![open]));
            camera = camera.with("shutterclose", Value::Floats(vec![close]));
        }
        self.accept(sensor, &["near_clip", "far_clip", "focus_distance", "aperture_radius", "srf", "kc"]);
        let medium = self.nested(sensor, "medium").first().map(|medium| self.medium(medium));
        self.finish(sensor);
        self.document.camera = Some(CameraEntity {
            entity: camera,
            world_from_camera: mirrored(&to_world),
            medium: medium.unwrap_or_default(),
        });
    }

    /// Our angle spans the shorter side, Mitsuba's the width unless it says otherwise.
    fn field_of_view(&mut self, sensor: &'e Element, resolution: [i32; 2], camera: &mut Entity) {
        let [width, height] = resolution.map(|n| n as f32);
        let shorter = width.min(height);
        let (mut axis, axis_span) = self.string(sensor, "fov_axis").unwrap_or(("x", sensor.span));
        let mut fov = self.float_opt(sensor, "fov");
        if let Some((length, span)) = self.string(sensor, "focal_length") {
            // Millimetres of a film of 36 x 24 mm, across the diagonal.
            match length.trim_end_matches("mm").trim().parse::<f32>() {
                Ok(length) if length > 0.0 => {
                    axis = "diagonal";
                    fov = Some(2.0 * (36.0_f32.hypot(24.0) / (2.0 * length)).atan().to_degrees());
                }
                _ => {
                    self.diagnostics.error(span, format!("`{length}` is not a focal length as in `50mm`"));
                }
            }
        }
        let side = match axis {
            "x" => width,
            "y" => height,
            "smaller" => shorter,
            "larger" => width.max(height),
            "diagonal" => width.hypot(height),
            _ => {
                let known = ["x", "y", "diagonal", "smaller", "larger"];
                self.diagnostics.unknown_name(axis_span, "axis", axis, known);
                width
            }
        };
        let fov = fov.unwrap_or_else(|| {
            // Mitsuba's default is the lens of 50 mm.
            axis_default(width, height, side)
        });
        if !(fov > 0.0 && fov < 180.0) {
            let message = format!("the field of view must lie between 0 and 180 degrees, not {fov}");
            self.diagnostics.error(sensor.span, message);
            return;
        }
        let half = (fov.to_radians() / 2.0).tan() * shorter / side;
        let fov = 2.0 * half.atan().to_degrees();
        *camera = std::mem::take(camera).with("fov", Value::Floats(vec![fov]));
        // The middle of the view lies off the middle of the picture, in shares of its size.
        let shift_x = self.float(sensor, "principal_point_offset_x", 0.0);
        let shift_y = self.float(sensor, "principal_point_offset_y", 0.0);
        if shift_x != 0.0 || shift_y != 0.0 {
            let (x, y) = (width / shorter, height / shorter);
            let (dx, dy) = (-2.0 * x * shift_x, 2.0 * y * shift_y);
            let window = vec![dx - x, dx + x, dy - y, dy + y];
            *camera = std::mem::take(camera).with("screenwindow", Value::Floats(window));
        }
    }

    /// The film of a sensor without one, with its size.
    fn default_film(&mut self, sensor: &Element) -> [i32; 2] {
        let size = [768, 576];
        let integers = |n: i32| Value::Integers(vec![n]);
        let film = entity("rgb", sensor);
        let film = film.with("xresolution", integers(size[0])).with("yresolution", integers(size[1]));
        self.document.film = Some(film);
        self.document.filter = Some(gaussian(sensor.span, 0.5));
        size
    }

    /// The size of the whole picture.
    fn film(&mut self, film: &'e Element) -> [i32; 2] {
        let known = ["hdrfilm", "ldrfilm", "tiledhdrfilm", "mfilm", "specfilm"];
        if !known.contains(&film.plugin()) {
            self.unknown_plugin(film, &[], &known, "");
        }
        let mut made = entity("rgb", film);
        let mut size = [self.integer(film, "width", 768), self.integer(film, "height", 576)];
        for (n, name) in size.iter_mut().zip(["width", "height"]) {
            if *n <= 0 {
                self.diagnostics
                    .error(film.span, format!("the {name} of the film must be positive, not {n}"));
                *n = 16;
            }
        }
        let spans = ["width", "height"]
            .map(|name| film.children.iter().find(|child| child.name == name).map_or(film.span, |c| c.span));
        made.parameters.push(parameter("xresolution", Value::Integers(vec![size[0]]), spans[0]));
        made.parameters.push(parameter("yresolution", Value::Integers(vec![size[1]]), spans[1]));
        self.crop(film, size, &mut made);
        match self.nested(film, "rfilter").first().copied() {
            Some(filter) => self.filter(filter),
            None => self.document.filter = Some(gaussian(film.span, 0.5)),
        }
        self.accept(
            film,
            &[
                "file_format",
                "pixel_format",
                "component_format",
                "sample_border",
                "compensate",
                "banner",
                "gamma",
                "tonemap_method",
                "tonemap_key",
                "exposure",
                "attach_log",
                "high_quality_edges",
                "variable",
                "label",
            ],
        );
        self.finish(film);
        self.document.film = Some(made);
        size
    }

    fn crop(&mut self, film: &'e Element, size: [i32; 2], made: &mut Entity) {
        let offset = [self.integer(film, "crop_offset_x", 0), self.integer(film, "crop_offset_y", 0)];
        let extent = [self.integer(film, "crop_width", size[0]), self.integer(film, "crop_height", size[1])];
        if offset == [0, 0] && extent == size {
            return;
        }
        let ends = [offset[0].saturating_add(extent[0]), offset[1].saturating_add(extent[1])];
        if offset.iter().chain(&extent).any(|n| *n < 0) || ends[0] > size[0] || ends[1] > size[1] {
            self.diagnostics.error(film.span, "the crop must lie within the film");
            return;
        }
        let bounds = Value::Integers(vec![offset[0], ends[0], offset[1], ends[1]]);
        made.parameters.push(parameter("pixelbounds", bounds, film.span));
    }

    fn filter(&mut self, filter: &'e Element) {
        let square = |name: &str, radius: f32| {
            entity(name, filter)
                .with("xradius", Value::Floats(vec![radius]))
                .with("yradius", Value::Floats(vec![radius]))
        };
        let made = match filter.plugin() {
            "box" => entity("box", filter),
            "tent" => square("triangle", self.float(filter, "radius", 1.0)),
            "gaussian" => gaussian(filter.plugin_span(), self.float(filter, "stddev", 0.5)),
            "mitchell" => {
                // What the paper calls B and C is A and B there.
                let b = self.float(filter, "a", 1.0 / 3.0);
                let c = self.float(filter, "b", 1.0 / 3.0);
                square("mitchell", 2.0).with("B", Value::Floats(vec![b])).with("C", Value::Floats(vec![c]))
            }
            "catmullrom" => square("mitchell", 2.0)
                .with("B", Value::Floats(vec![0.0]))
                .with("C", Value::Floats(vec![0.5])),
            "lanczos" => {
                let lobes = self.float(filter, "lobes", 3.0);
                square("sinc", lobes).with("tau", Value::Floats(vec![lobes]))
            }
            _ => {
                self.unknown_plugin(filter, &[], FILTERS, "");
                return;
            }
        };
        self.accept(filter, &["radius"]);
        self.finish(filter);
        self.document.filter = Some(made);
    }

    fn sampler(&mut self, sampler: &'e Element) {
        let count = self.integer(sampler, "sample_count", 4).max(1);
        let seed = self.integer(sampler, "seed", 0);
        self.accept(sampler, &["jitter", "scramble", "dimension", "strength"]);
        let Some((_, name)) = SAMPLERS.iter().find(|(theirs, _)| *theirs == sampler.plugin()) else {
            let known: Vec<_> = SAMPLERS.iter().map(|(name, _)| *name).collect();
            self.unknown_plugin(sampler, &[], &known, "");
            return;
        };
        self.finish(sampler);
        let mut made = entity(name, sampler);
        let counts: &[(&str, i32)] = if *name == "stratified" {
            let x = (count as f32).sqrt().round().max(1.0) as i32;
            &[("xsamples", x), ("ysamples", (count + x - 1) / x)]
        } else {
            &[("pixelsamples", count)]
        };
        for (name, n) in counts {
            made.parameters.push(parameter(name, Value::Integers(vec![*n]), sampler.span));
        }
        if seed != 0 {
            made.parameters.push(parameter("seed", Value::Integers(vec![seed]), sampler.span));
        }
        self.document.sampler = Some(made);
    }

    pub(super) fn integrator(&mut self, integrator: &'e Element) {
        let name = integrator.plugin();
        if AROUND_OTHERS.contains(&name) {
            for child in &integrator.children {
                child.used.set(true);
            }
            if !matches!(name, "moment" | "multichannel") {
                let message = format!("`{name}` adds nothing here; the integrator inside of it renders");
                self.diagnostics.warning(integrator.plugin_span(), message);
            }
            if let Some(inner) = self.nested(integrator, "integrator").first().copied() {
                let _ = self.guarded(integrator, |reader| {
                    reader.integrator(inner);
                    Some(())
                });
            }
            return;
        }
        let Some((_, ours)) = INTEGRATORS.iter().find(|(theirs, _)| *theirs == name) else {
            let known: Vec<_> = INTEGRATORS.iter().map(|(name, _)| *name).collect();
            self.unknown_plugin(integrator, MISSING_INTEGRATORS, &known, "`path` stands in for it");
            self.document.integrator = Some(entity("path", integrator));
            return;
        };
        let mut made = entity(ours, integrator);
        // Mitsuba counts seen emission as depth 1.
        let depth = match self.integer(integrator, "max_depth", if name == "direct" { 2 } else { -1 }) {
            negative if negative < 0 => UNLIMITED_DEPTH,
            depth => (depth - 1).max(0),
        };
        if matches!(*ours, "path" | "volpath" | "simplevolpath") {
            made.parameters.push(parameter("maxdepth", Value::Integers(vec![depth]), integrator.span));
        }
        let why = "lights are as visible as they are";
        if self.boolean(integrator, "hide_emitters", false) {
            self.ignore(integrator, &["hide_emitters"], why);
        }
        for child in &integrator.children {
            child.used.set(true);
        }
        self.finish(integrator);
        self.document.integrator = Some(made);
    }
}

/// The angle across `side` of a lens of 50 mm on film of 36 x 24 mm, whose diagonal is that of the picture.
fn axis_default(width: f32, height: f32, side: f32) -> f32 {
    let half_diagonal = 36.0_f32.hypot(24.0) / (2.0 * 50.0);
    2.0 * (half_diagonal * side / width.hypot(height)).atan().to_degrees()
}

fn gaussian(span: Span, deviation: f32) -> Entity {
    let radius = Value::Floats(vec![4.0 * deviation]);
    let mut filter = Entity { span: Some(span), ..Entity::new("gaussian") };
    for (name, value) in
        [("xradius", radius.clone()), ("yradius", radius), ("sigma", Value::Floats(vec![deviation]))]
    {
        filter.parameters.push(parameter(name, value, span));
    }
    filter
}

fn strings(text: &str) -> Value {
    Value::Strings(vec![text.to_owned()])
}
