#include "content/load/gltf_mesh.h"

#include "content/bake/tangents.h"
#include "content/load/gltf_accessor.h"
#include "content/load/gltf_deform.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace limn {

namespace {

constexpr float kCreaseAngle = radians(50);

/// [m]; beyond it the products of edges that make normals overflow a float.
constexpr float kLargestPosition = 1e9f;

/// The three corners of each triangle, from the index list of a list, strip or fan.
std::vector<std::uint32_t> make_triangles(const std::vector<std::uint32_t>& list, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        return list;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < list.size(); ++i) {
        // Every second triangle of a strip is wound the other way; a fan turns about its first
        // vertex.
        const bool odd = (i & 1u) != 0;
        const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
        const std::uint32_t a = list[fan ? 0 : i];
        const std::uint32_t b = list[fan || !odd ? i + 1 : i + 2];
        const std::uint32_t c = list[fan || !odd ? i + 2 : i + 1];
        if (a != b && b != c && c != a) {  // strips are joined by triangles without an area
            triangles.insert(triangles.end(), {a, b, c});
        }
    }
    return triangles;
}

/// extras.targetNames of the mesh, as most exporters write them.
std::vector<std::string> morph_names(const GltfDocument& document, std::size_t mesh) {
    std::vector<std::string> names;
    const JsonValue* extras = json_item(document, "meshes", mesh).find("extras");
    const JsonValue* list = extras != nullptr ? extras->find("targetNames") : nullptr;
    if (list != nullptr && list->kind == JsonKind::Array) {
        for (const JsonValue& name : list->items) {
            names.push_back(name.text);
        }
    }
    return names;
}

/// The joints that every skin has with which a node draws the mesh; 0: it is drawn without.
std::size_t common_joints(const tinygltf::Model& model, std::size_t mesh) {
    std::size_t count = 0;
    for (const tinygltf::Node& node : model.nodes) {
        if (node.mesh == static_cast<int>(mesh) && node.skin >= 0) {
            const std::size_t joints =
                model.skins[static_cast<std::size_t>(node.skin)].joints.size();
            count = count == 0 ? joints : std::min(count, joints);
        }
    }
    return count;
}

class MeshBuilder {
  public:
    MeshBuilder(GltfDocument& document, std::size_t mesh, std::size_t primitive)
        : document_(document), mesh_(mesh),
          source_(document.model.meshes[mesh].primitives[primitive]),
          place_(fmt::format("{}: meshes[{}].primitives[{}]", document.file, mesh, primitive)) {
        result_.name = document.model.meshes[mesh].name;
        if (document.model.meshes[mesh].primitives.size() > 1 && !result_.name.empty()) {
            result_.name += fmt::format(".{}", primitive);
        }
    }

    Result<std::optional<MeshData>> build() {
        if (source_.mode < TINYGLTF_MODE_TRIANGLES) {
            return skip("points and lines are not drawn");
        }
        if (!source_.attributes.contains("POSITION")) {
            return skip("it has no POSITION");
        }
        for (const auto step :
             {&MeshBuilder::read_positions, &MeshBuilder::read_triangles,
              &MeshBuilder::read_attributes, &MeshBuilder::read_deformations}) {
            if (Status status = (this->*step)(); !status) {
                return status.error();
            }
        }
        if (result_.indices.empty()) {
            return skip("none of its triangles has three different corners");
        }
        complete();
        return std::optional(std::move(result_));
    }

  private:
    Result<std::optional<MeshData>> skip(std::string_view why) {
        document_.warnings.push_back(fmt::format("{} is left out: {}", place_, why));
        return std::optional<MeshData>();
    }

    Status read_positions() {
        const std::string place = place_ + ".attributes.POSITION";
        const Result<std::vector<float>> values =
            read_floats(document_, source_.attributes.at("POSITION"), 3, place);
        if (!values) {
            return values.error();
        }
        positions_.resize(values->size() / 3);
        std::memcpy(positions_.data(), values->data(), values->size() * sizeof(float));
        for (std::size_t i = 0; i < values->size(); ++i) {
            if (std::abs((*values)[i]) > kLargestPosition) {
                return fail(
                    "{}: found {} in element {}, expected at most {}", place, (*values)[i], i / 3,
                    kLargestPosition);
            }
        }
        return Done{};
    }

    /// Fills the indices and keeps, in `used_`, the vertices they name in order of appearance.
    Status read_triangles() {
        std::vector<std::uint32_t> list;
        const std::string place = place_ + ".indices";
        if (source_.indices >= 0) {
            Result<std::vector<std::uint32_t>> indices =
                read_indices(document_, source_.indices, place);
            if (!indices) {
                return indices.error();
            }
            list = std::move(*indices);
        } else {
            list.resize(positions_.size());
            for (std::size_t i = 0; i < list.size(); ++i) {
                list[i] = static_cast<std::uint32_t>(i);
            }
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i] >= positions_.size()) {
                return fail(
                    "{}: found {} at {}, expected an index below the {} vertices", place, list[i],
                    i, positions_.size());
            }
        }
        if (source_.mode == TINYGLTF_MODE_TRIANGLES && list.size() % 3 != 0) {
            return fail("{}: found {} corners, expected three a triangle", place, list.size());
        }
        result_.indices = make_triangles(list, source_.mode);
        std::vector<std::uint32_t> number(positions_.size(), kNoAsset);
        for (std::uint32_t& index : result_.indices) {
            if (number[index] == kNoAsset) {
                number[index] = static_cast<std::uint32_t>(used_.size());
                used_.push_back(index);
            }
            index = number[index];
        }
        result_.positions = gather(positions_);
        return Done{};
    }

    template <typename T>
    std::vector<T> gather(const std::vector<T>& all) const {
        std::vector<T> values;
        values.reserve(used_.size());
        for (const std::uint32_t index : used_) {
            values.push_back(all[index]);
        }
        return values;
    }

    /// The attribute `name`, for the vertices in use; empty when the file has none.
    template <typename T>
    Status read(const char* name, std::vector<T>& target) {
        const auto found = source_.attributes.find(name);
        if (found == source_.attributes.end()) {
            return Done{};
        }
        const std::string place = fmt::format("{}.attributes.{}", place_, name);
        const Result<std::vector<float>> values =
            read_floats(document_, found->second, static_cast<int>(T::length()), place);
        if (!values) {
            return values.error();
        }
        std::vector<T> all(values->size() / static_cast<std::size_t>(T::length()));
        if (all.size() != positions_.size()) {
            return fail(
                "{}: found {} elements, expected as many as POSITION has, {}", place, all.size(),
                positions_.size());
        }
        std::memcpy(all.data(), values->data(), values->size() * sizeof(float));
        target = gather(all);
        return Done{};
    }

    Status read_attributes() {
        if (Status status = read("NORMAL", result_.normals); !status) {
            return status;
        }
        if (Status status = read("TANGENT", result_.tangents); !status) {
            return status;
        }
        if (Status status = read("TEXCOORD_0", result_.uvs); !status) {
            return status;
        }
        if (Status status = read("TEXCOORD_1", result_.uvs1); !status) {
            return status;
        }
        return read_colors();
    }

    Status read_colors() {
        const auto found = source_.attributes.find("COLOR_0");
        if (found == source_.attributes.end() || component_count(document_, found->second) == 4) {
            return read("COLOR_0", result_.colors);
        }
        std::vector<Vec3> opaque;
        if (Status status = read("COLOR_0", opaque); !status) {
            return status;
        }
        for (const Vec3& color : opaque) {
            result_.colors.emplace_back(color, 1.0f);
        }
        return Done{};
    }

    Status read_deformations() {
        const GltfVertices vertices{source_, place_, positions_.size(), used_};
        if (const std::size_t joints = common_joints(document_.model, mesh_); joints > 0) {
            Result<SkinWeights> skin = read_skin_weights(document_, vertices, joints);
            if (!skin) {
                return skin.error();
            }
            result_.skin = std::move(*skin);
        }
        Result<std::vector<MorphTarget>> morphs =
            read_morph_targets(document_, vertices, morph_names(document_, mesh_));
        if (!morphs) {
            return morphs.error();
        }
        result_.morphs = std::move(*morphs);
        return Done{};
    }

    /// The set of texture coordinates that the normal map uses, if the mesh has it.
    [[nodiscard]] int tangent_uv_set() const {
        const bool asks_for_second =
            source_.material >= 0
            && document_.model.materials[static_cast<std::size_t>(source_.material)]
                       .normalTexture.texCoord
                   == 1;
        return asks_for_second && !result_.uvs1.empty() ? 1 : 0;
    }

    void complete() {
        if (result_.uvs.empty()) {
            result_.uvs.assign(result_.positions.size(), Vec2(0));
        }
        if (result_.normals.empty()) {
            // What else there is would not fit the new normals.
            result_.tangents.clear();
            for (MorphTarget& morph : result_.morphs) {
                morph.normals.clear();
            }
            generate_normals(result_, kCreaseAngle);
            generate_morph_normals(result_);
        }
        for (Vec3& normal : result_.normals) {
            normal = normalize_or(normal, Vec3(0, 1, 0));
        }
        if (result_.tangents.empty()) {
            for (MorphTarget& morph : result_.morphs) {
                morph.tangents.clear();
            }
            generate_tangents(result_, tangent_uv_set());
        }
        for (std::size_t i = 0; i < result_.tangents.size(); ++i) {
            Vec4& tangent = result_.tangents[i];
            const Vec3 direction =
                normalize_or(Vec3(tangent), any_perpendicular(result_.normals[i]));
            tangent = Vec4(direction, tangent.w < 0 ? -1.0f : 1.0f);
        }
        generate_morph_tangents(result_);
        update_bounds(result_);
    }

    GltfDocument& document_;
    std::size_t mesh_;
    const tinygltf::Primitive& source_;
    std::string place_;
    std::vector<Vec3> positions_;      ///< all of the accessor
    std::vector<std::uint32_t> used_;  ///< vertices of the file that the triangles name
    MeshData result_;
};

}  // namespace

Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive) {
    return MeshBuilder(document, mesh, primitive).build();
}

}  // namespace limn
