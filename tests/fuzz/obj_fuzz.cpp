// Bytes into the OBJ and MTL readers and the mesh made of them: whatever they are, there is a valid
// mesh or one line.

#include "content/load/obj/obj_material.h"
#include "content/load/obj/obj_scene.h"

#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace {

const limn::ObjLimits kLimits = {
    .max_bytes = 1 << 20, .max_vertices = 1 << 14, .max_corners = 1 << 14, .max_names = 1 << 10};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

void check_mesh(const limn::ObjFile& obj) {
    std::vector<std::uint32_t> faces;
    std::size_t triangles = 0;
    for (std::uint32_t f = 0; f < obj.faces.size(); ++f) {
        const limn::ObjFace& face = obj.faces[f];
        require(face.count >= 3 && face.first + face.count <= obj.corners.size());
        require(face.object < obj.objects.size() && face.group < obj.groups.size());
        require(face.material < obj.materials.size());
        triangles += face.count - 2;
        faces.push_back(f);
    }
    const limn::ObjMesh made = limn::make_obj_mesh(obj, faces);
    const limn::MeshData& mesh = made.mesh;
    require(mesh.indices.size() == 3 * triangles);
    require(mesh.uvs.size() == mesh.positions.size());
    require(made.source.size() == mesh.positions.size());
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    for (const std::uint32_t index : mesh.indices) {
        require(index < mesh.positions.size());
    }
    for (const limn::Vec3& position : mesh.positions) {
        require(limn::is_finite(position));
    }
    require(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
    for (const limn::Vec4& color : mesh.colors) {
        for (int i = 0; i < 4; ++i) {
            require(color[i] >= 0 && color[i] <= 1);
        }
    }
    for (const limn::Vec3& normal : mesh.normals) {
        require(std::abs(glm::length(normal) - 1.0f) < 1e-3f);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const limn::Result<limn::ObjFile> obj = limn::parse_obj(text, "fuzz.obj", kLimits)) {
        check_mesh(*obj);
    } else {
        require(!obj.error().message.empty());
        require(obj.error().message.find('\n') == std::string::npos);
    }
    if (const auto library = limn::parse_obj_materials(text, "fuzz.mtl", kLimits)) {
        for (const limn::ObjMaterial& material : library->materials) {
            require(material.opacity.value_or(1) >= 0 && material.opacity.value_or(1) <= 1);
            require(limn::is_finite(material.diffuse.value_or(limn::Vec3(0))));
            require(limn::is_finite(material.emission.value_or(limn::Vec3(0))));
            require(std::isfinite(material.shininess));
        }
    }
    return 0;
}
