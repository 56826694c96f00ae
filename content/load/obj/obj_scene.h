#pragma once

#include "content/load/files/load_warnings.h"
#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_file.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Wavefront OBJ files as scenes, to look at, and as meshes for importers.

/// A mesh, and for each of its vertices the position of the file that it was made from.
struct ObjMesh {
    MeshData mesh;
    std::vector<std::uint32_t> source;
};

/// The mesh of the faces with these indices, cut into triangles; without tangents, and without
/// normals unless all corners have one. A corner with a texture coordinate or normal of its own
/// gets a vertex of its own; vertices are in the order in which the triangles use them.
[[nodiscard]] ObjMesh make_obj_mesh(const ObjFile& obj, std::span<const std::uint32_t> faces);

/// A node for each object and group with faces, in parts by material, and one each for points and
/// lines (gltf_strokes.h); a file with vertices alone is a cloud of points. Missing normals are
/// generated as for glTF. Materials are those of the file's libraries under its folder
/// (obj_textures.h); where none defines one, it is gray, or white under the colors of vertices.
/// What is left out or ignored is in the scene's warnings, which are logged.
[[nodiscard]] Result<GltfScene> load_obj_scene(
    const std::string& path, const ObjLimits& limits = {}, const LoadOptions& options = {});

}  // namespace limn
