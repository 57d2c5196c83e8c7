//! The hierarchy of nodes: what is where, and what is there several times.
//!
//! Nodes are walked with explicit stacks, since a file may nest a million of them.

use std::collections::HashMap;
use std::sync::Arc;

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::document::{
    EmbeddedFile, Entity, InstanceEntity, MaterialReference, ObjectEntity, ShapeEntity, Value,
};

use super::accessors::Accessor;
use super::file::span;
use super::material::Surface;
use super::matrix::Matrix;
use super::mesh::Wanted;
use super::{PER_INSTANCE, Reader, located};
use crate::json::Json;

/// All nodes with their place in the world.
struct Hierarchy<'a> {
    nodes: &'a [Json],
    children: Vec<Vec<usize>>,
    world: Vec<Matrix>,
}

/// Where a mesh is shown as it is, by the nodes that show it.
type Uses<'a> = Vec<(&'a Json, Vec<Matrix>)>;

impl<'a> Reader<'a> {
    pub(super) fn read_scene(&mut self) {
        let hierarchy = self.hierarchy();
        let visible = self.visible(&hierarchy);
        let mut uses: Uses<'a> = Vec::new();
        let mut by_mesh: HashMap<usize, usize> = HashMap::new();
        let mut n_cameras = 0;
        for index in visible {
            let (node, world) = (&hierarchy.nodes[index], hierarchy.world[index]);
            if let Some((mesh_index, mesh)) = self.file.reference(node, "mesh", "meshes") {
                if node.get("skin").is_some() || node.get("weights").is_some() {
                    self.posed_mesh(index, node, mesh, &hierarchy);
                } else {
                    let place = *by_mesh.entry(mesh_index).or_insert_with(|| {
                        uses.push((mesh, Vec::new()));
                        uses.len() - 1
                    });
                    let places = self.places(node, world);
                    uses[place].1.extend(places);
                }
            }
            if let Some((_, camera)) = self.file.reference(node, "camera", "cameras") {
                n_cameras += 1;
                if n_cameras == 1 {
                    self.camera(camera, &world);
                }
            }
            if let Some(light) = self.file.extension(node, "KHR_lights_punctual")
                && let Some(light) = self.light_of(light)
            {
                self.light(light, &world);
            }
        }
        if n_cameras > 1 {
            let at = self.file.root.get("cameras").unwrap_or(self.file.root);
            self.file.warning(at, format!("the scene has {n_cameras} cameras; the first is taken"));
        }
        for (mesh, places) in uses {
            self.mesh(mesh, &places);
        }
        self.document.integrator.get_or_insert_with(|| Entity::new("path"));
    }

    /// The light that the extension of a node refers to.
    fn light_of(&self, extension: &'a Json) -> Option<&'a Json> {
        let at = self.file.required(extension, "light")?;
        let index = self.file.as_size(at)?;
        let all = self.file.extension(self.file.root, "KHR_lights_punctual");
        let lights = all.map_or(&[][..], |all| self.file.array(all, "lights"));
        if lights.get(index).is_none() {
            self.file.error(at, format!("there is no light {index}: the file has {}", lights.len()));
        }
        lights.get(index)
    }

    fn hierarchy(&self) -> Hierarchy<'a> {
        let nodes = self.file.array(self.file.root, "nodes");
        let mut children = vec![Vec::new(); nodes.len()];
        let mut has_parent = vec![false; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            for at in self.file.array(node, "children") {
                let Some(child) = self.file.as_size(at) else { continue };
                if self.file.item(at, "nodes", child).is_none() {
                    continue;
                }
                if std::mem::replace(&mut has_parent[child], true) {
                    self.file.error(at, format!("node {child} is a child of two nodes, or twice of one"));
                    continue;
                }
                children[index].push(child);
            }
        }
        let mut world: Vec<Option<Matrix>> = vec![None; nodes.len()];
        let mut stack: Vec<usize> = (0..nodes.len()).filter(|index| !has_parent[*index]).collect();
        for root in &stack {
            world[*root] = Some(self.local(&nodes[*root]));
        }
        while let Some(parent) = stack.pop() {
            let world_from_parent = world[parent].unwrap_or(Matrix::IDENTITY);
            for child in &children[parent] {
                world[*child] = Some(world_from_parent.times(&self.local(&nodes[*child])));
                stack.push(*child);
            }
        }
        // What no root leads to is its own ancestor.
        if let Some(index) = world.iter().position(Option::is_none) {
            self.file.error(&nodes[index], "the node is among its own ancestors");
            children.fill(Vec::new());
        }
        let world = world.into_iter().map(|world| world.unwrap_or(Matrix::IDENTITY)).collect();
        Hierarchy { nodes, children, world }
    }

    /// From a node to its parent.
    fn local(&self, node: &'a Json) -> Matrix {
        if let Some(columns) = self.file.floats(node, "matrix") {
            return Matrix::from_columns(&columns);
        }
        let translation = self.file.floats(node, "translation").unwrap_or([0.0; 3]);
        let rotation = self.file.floats(node, "rotation").unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let scale = self.file.floats(node, "scale").unwrap_or([1.0; 3]);
        Matrix::from_parts(translation, rotation, scale)
    }

    /// Nodes of the scene that is shown, parents before their children.
    fn visible(&self, hierarchy: &Hierarchy<'a>) -> Vec<usize> {
        let root = self.file.root;
        let scenes = self.file.array(root, "scenes");
        let index = self.file.size(root, "scene", 0);
        let mut stack: Vec<usize> = match scenes.get(index) {
            Some(scene) => {
                let node = |at| {
                    let index = self.file.as_size(at)?;
                    self.file.item(at, "nodes", index).map(|_| index)
                };
                self.file.array(scene, "nodes").iter().filter_map(node).collect()
            }
            None => {
                if let Some(at) = root.get("scene") {
                    self.file.error(at, format!("there is no scene {index}: the file has {}", scenes.len()));
                }
                (0..hierarchy.nodes.len()).collect()
            }
        };
        stack.reverse();
        let (mut seen, mut order) = (vec![false; hierarchy.nodes.len()], Vec::new());
        while let Some(index) = stack.pop() {
            if !std::mem::replace(&mut seen[index], true) {
                order.push(index);
                stack.extend(hierarchy.children[index].iter().rev());
            }
        }
        order
    }

    /// Where a node shows its mesh: once, or as often as `EXT_mesh_gpu_instancing` says.
    fn places(&self, node: &'a Json, world: Matrix) -> Vec<Matrix> {
        let Some(extension) = self.file.extension(node, "EXT_mesh_gpu_instancing") else {
            return vec![world];
        };
        let Some(attributes) = self.file.object(extension, "attributes") else { return vec![world] };
        let read = |name: &str, n: usize| {
            let at = attributes.get(name)?;
            let accessor = Accessor::read(&self.file, &self.buffers, at, self.file.as_size(at)?)?;
            if accessor.n_components == n {
                return Some(accessor);
            }
            self.file.error(at, format!("\"{name}\" needs elements of {n} numbers"));
            None
        };
        let (translation, rotation, scale) = (read("TRANSLATION", 3), read("ROTATION", 4), read("SCALE", 3));
        let counts = [&translation, &rotation, &scale].map(|accessor| accessor.as_ref().map(|a| a.count));
        let Some(count) = counts.into_iter().flatten().min() else { return vec![world] };
        if self.charge(extension, count.saturating_mul(PER_INSTANCE)).is_none() {
            return Vec::new();
        }
        let place = |i: usize| {
            world.times(&Matrix::from_parts(
                translation.as_ref().map_or([0.0; 3], |a| a.floats(i)),
                rotation.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |a| a.floats(i)),
                scale.as_ref().map_or([1.0; 3], |a| a.floats(i)),
            ))
        };
        (0..count).map(place).collect()
    }

    /// A mesh that is shown as it is, at one or more places.
    fn mesh(&mut self, mesh: &'a Json, places: &[Matrix]) {
        let name = self.file.root.pointer(mesh.start).trim_start_matches('/').to_owned();
        let weights = self.weights(mesh, mesh);
        let mut shared = Vec::new();
        let transforms: Vec<_> = places.iter().filter_map(Matrix::transform).collect();
        if transforms.len() < places.len() {
            let message = "a node that shows the mesh flattens it to nothing; it is left out there";
            self.file.warning(mesh, message);
        }
        let Some(n_more) = transforms.len().checked_sub(1) else { return };
        for (index, primitive) in self.file.array(mesh, "primitives").iter().enumerate() {
            let surface = self.surface_of(primitive);
            let part = format!("{name}/primitives/{index}");
            let wanted = Wanted {
                texcoord: surface.texcoord,
                tangents: surface.needs_tangents,
                vertex_color: surface.vertex_color,
                weights: &weights,
                joints: None,
            };
            let Some(shape) = self.shape(primitive, &part, &surface, &wanted) else { continue };
            // Shapes of objects cannot be lights.
            if n_more == 0 || shape.area_light.is_some() {
                let each = self.n_elements(&shape).saturating_add(PER_INSTANCE);
                if self.charge(primitive, each.saturating_mul(n_more)).is_none() {
                    continue;
                }
                for transform in &transforms {
                    let world_from_object = AnimatedTransform::constant(*transform);
                    self.document.shapes.push(ShapeEntity { world_from_object, ..shape.clone() });
                }
            } else {
                shared.push(shape);
            }
        }
        if shared.is_empty() {
            return;
        }
        let place = Some(span(mesh));
        self.document.objects.push(ObjectEntity { name: name.clone(), span: place, shapes: shared });
        self.document.instances.extend(transforms.into_iter().map(|transform| InstanceEntity {
            object: name.clone(),
            span: place,
            world_from_instance: AnimatedTransform::constant(transform),
        }));
    }

    /// Vertices and triangles of the mesh that a shape shows.
    fn n_elements(&self, shape: &ShapeEntity) -> usize {
        let name = shape.entity.parameters.first().map(|p| &p.value);
        let Some(Value::Strings(names)) = name else { return 0 };
        match names.first().and_then(|name| self.document.embedded.get(name)) {
            Some(EmbeddedFile::Mesh(mesh)) => mesh.positions.len() + mesh.triangles.len(),
            _ => 0,
        }
    }

    /// A mesh that a node bends, by a skin or by weights of its own.
    fn posed_mesh(&mut self, index: usize, node: &'a Json, mesh: &'a Json, hierarchy: &Hierarchy<'a>) {
        let joints = self.joints(node, hierarchy);
        let weights = self.weights(node, mesh);
        // A skin places its vertices in the world, wherever the node is.
        let world = if joints.is_some() { Matrix::IDENTITY } else { hierarchy.world[index] };
        let Some(transform) = world.transform() else {
            self.file.warning(node, "the node flattens its mesh to nothing; it is left out");
            return;
        };
        for (number, primitive) in self.file.array(mesh, "primitives").iter().enumerate() {
            let surface = self.surface_of(primitive);
            let part = format!("nodes/{index}/primitives/{number}");
            let wanted = Wanted {
                texcoord: surface.texcoord,
                tangents: surface.needs_tangents,
                vertex_color: surface.vertex_color,
                weights: &weights,
                joints: joints.as_deref(),
            };
            let Some(mut shape) = self.shape(primitive, &part, &surface, &wanted) else { continue };
            shape.world_from_object = AnimatedTransform::constant(transform);
            self.document.shapes.push(shape);
        }
    }

    /// Weights of morph targets: those of a node or of its mesh.
    fn weights(&self, node: &'a Json, mesh: &'a Json) -> Vec<f32> {
        let object = if node.get("weights").is_some() { node } else { mesh };
        let weights = self.file.array(object, "weights").iter();
        weights.map(|weight| self.file.as_float(weight).unwrap_or(0.0)).collect()
    }

    /// Maps of the joints of a node's skin, from the mesh to the world.
    fn joints(&self, node: &'a Json, hierarchy: &Hierarchy<'a>) -> Option<Vec<Matrix>> {
        let (_, skin) = self.file.reference(node, "skin", "skins")?;
        let joints = self.file.array(skin, "joints");
        let inverse = skin.get("inverseBindMatrices").and_then(|at| {
            let accessor = Accessor::read(&self.file, &self.buffers, at, self.file.as_size(at)?)?;
            if accessor.n_components == 16 && accessor.count >= joints.len() {
                return Some(accessor);
            }
            let n = joints.len();
            self.file.error(at, format!("\"inverseBindMatrices\" needs a MAT4 for each of {n} joints"));
            None
        });
        self.charge(skin, joints.len())?;
        let map = |(index, at): (usize, &'a Json)| {
            let joint = self.file.as_size(at)?;
            self.file.item(at, "nodes", joint)?;
            let world = hierarchy.world[joint];
            let rest = inverse.as_ref().map(|accessor| Matrix::from_columns(&accessor.floats(index)));
            Some(rest.map_or(world, |rest| world.times(&rest)))
        };
        joints.iter().enumerate().map(map).collect()
    }

    fn surface_of(&mut self, primitive: &'a Json) -> Surface {
        let is_tinted = self.is_tinted(primitive);
        match self.file.reference(primitive, "material", "materials") {
            Some((index, material)) => self.surface(index, material, is_tinted),
            None => self.default_surface(is_tinted),
        }
    }

    /// A primitive as a shape, its mesh embedded into the document under that name.
    fn shape(
        &mut self,
        primitive: &'a Json,
        part: &str,
        surface: &Surface,
        wanted: &Wanted<'_>,
    ) -> Option<ShapeEntity> {
        let mesh = self.primitive(primitive, wanted)?;
        if surface.needs_uv && mesh.uvs.is_empty() {
            let message = format!("the material has textures, but there is no TEXCOORD_{}", surface.texcoord);
            self.file.warning(primitive, message);
        }
        let file = self.document.embed(part, EmbeddedFile::Mesh(Arc::new(mesh)));
        let mut entity = Entity::new("plymesh").with("filename", Value::Strings(vec![file]));
        if let Some(alpha) = &surface.alpha {
            entity = entity.with("alpha", alpha.clone());
        }
        let material: MaterialReference = surface.material.clone();
        Some(ShapeEntity {
            entity: located(entity, primitive),
            world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
            reverse_orientation: false,
            material,
            area_light: surface.area_light,
            inside_medium: String::new(),
            outside_medium: String::new(),
            has_medium_interface: false,
        })
    }
}
