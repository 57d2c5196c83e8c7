//! Vertices that move between renders: hierarchies are refitted, not built anew.

#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Normal3, Point3};

use crate::accelerator::Group;
use crate::builder::{self, WORLD};
use crate::bvh::{self, Bvh, INSTANCE, PrimitiveRef};
use crate::geometry::Geometry;
use crate::hit::GeometryId;
use crate::mesh::MeshError;
use crate::shape::entity_of;

/// New places for the vertices of a triangle mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedVertices {
    /// The mesh.
    pub geometry: GeometryId,
    /// As many positions as before, in world space, or in the space of the object that holds the mesh.
    pub positions: Vec<Point3>,
    /// Shading normals in the same space, as hits are to have them; empty to keep those there are.
    pub normals: Vec<Normal3>,
}

impl Geometry {
    /// Moves the vertices of triangle meshes. Rays then meet what they would meet after a build from scratch, which
    /// takes about four times as long, but which makes rays faster where vertices have changed places a lot.
    ///
    /// Nothing changes where an array has the wrong length or holds a number that is not finite.
    pub fn move_vertices(&mut self, moved: Vec<MovedVertices>) -> Result<(), MeshError> {
        for mesh in &moved {
            self.entities[mesh.geometry.0 as usize].check_vertices(&mesh.positions, &mesh.normals)?;
        }
        let mut groups: Vec<u32> =
            moved.iter().map(|mesh| self.entity_groups[mesh.geometry.0 as usize]).collect();
        for MovedVertices { geometry, positions, normals } in moved {
            self.entities[geometry.0 as usize].set_vertices(positions, normals);
        }
        groups.sort_unstable();
        groups.dedup();
        let mut is_new = false;
        for group in groups.iter().copied().filter(|group| *group != WORLD) {
            is_new |= !self.refit_group(group);
        }
        // Last, since instances have moved with their objects.
        if is_new {
            self.build_group(WORLD);
        } else if !groups.is_empty() {
            self.refit_group(WORLD);
        }
        Ok(())
    }

    /// Refits a hierarchy, or builds it anew where it no longer fits; true if it did. Other structures are built anew.
    fn refit_group(&mut self, group: u32) -> bool {
        if self.structures.is_some() {
            self.build_group(group);
            return false;
        }
        let mut bvh = std::mem::take(&mut self.groups[group as usize]);
        let corners = |r: PrimitiveRef| self.entities[entity_of(r)].valid_triangle(r.primitive);
        let n_found = bvh.refit(&corners, &|item| {
            if item.geometry == INSTANCE {
                return self.instance_bounds(item.primitive);
            }
            Some(self.entities[item.geometry as usize].bounds(item.primitive))
        });
        let own = self.entities.iter().zip(&self.entity_groups).filter(|(_, own)| **own == group);
        let n_valid: usize = own.map(|(entity, _)| entity.n_valid_triangles()).sum();
        let fits = n_found == Some(n_valid);
        if fits {
            self.groups[group as usize] = bvh;
        } else {
            self.build_group(group);
        }
        fits
    }

    fn build_group(&mut self, group: u32) {
        let n_instances = if group == WORLD { self.instances.len() as u32 } else { 0 };
        let bounds = (0..n_instances).map(|index| self.instance_bounds(index));
        let (entities, entity_groups) = (&self.entities[..], &self.entity_groups[..]);
        let Some(accelerator) = self.structures.as_ref().map(|structures| structures.accelerator) else {
            let bvh = builder::build_group(entities, entity_groups, group, bounds, bvh::build);
            self.groups[group as usize] = bvh;
            return;
        };
        let build = |own, source: &_| Group::build(own, source, &accelerator);
        let new = builder::build_group(entities, entity_groups, group, bounds, build);
        self.groups[group as usize] = Bvh::placeholder(new.bounds());
        if let Some(structures) = &mut self.structures {
            structures.groups[group as usize] = new;
        }
    }

    fn instance_bounds(&self, index: u32) -> Option<Bounds3> {
        let instance = &self.instances[index as usize];
        instance.world_bounds(self.groups[instance.group as usize].bounds())
    }
}
