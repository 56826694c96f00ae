#include "content/bake/tangents.h"
#include "content/load/gltf_document.h"
#include "content/load/gltf_strokes.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

namespace limn {

namespace {

constexpr float kCreaseAngle = radians(50);

/// [m]; beyond it cross products of edges overflow a float.
constexpr float kLargestPosition = 1e9f;

/// The three corners of each triangle, from the index list of a list, strip or fan.
std::vector<std::uint32_t>
make_triangles(const std::vector<std::uint32_t>& list, std::int32_t mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        return list;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < list.size(); ++i) {
        // Every second triangle of a strip has reversed winding; a fan is about its first vertex.
        const bool odd = (i & 1u) != 0;
        const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
        const std::uint32_t a = list[fan ? 0 : i];
        const std::uint32_t b = list[fan || !odd ? i + 1 : i + 2];
        const std::uint32_t c = list[fan || !odd ? i + 2 : i + 1];
        if (a != b && b != c && c != a) {  // degenerate triangles join strips
            triangles.insert(triangles.end(), {a, b, c});
        }
    }
    return triangles;
}

class MeshBuilder {
  public:
    MeshBuilder(GltfDocument& document, std::size_t mesh, std::size_t primitive, std::size_t joints)
        : document_(document), mesh_(mesh),
          source_(document.model.meshes[mesh].primitives[primitive]), joints_(joints),
          place_(fmt::format("{}: meshes[{}].primitives[{}]", document.file, mesh, primitive)) {
        const tinygltf::Mesh& all = document.model.meshes[mesh];
        result_.name = all.name;
        if (all.primitives.size() > 1 && !result_.name.empty()) {
            result_.name += fmt::format(".{}", primitive);
        }
    }

    Result<std::optional<MeshData>> build() {
        if (find_attribute("POSITION") < 0) {
            return skip("it has no POSITION attribute");
        }
        if (!has_data(find_attribute("POSITION")) && source_.targets.empty()) {
            return skip("its positions are not in the file");
        }
        if (source_.indices >= 0 && !has_data(source_.indices)) {
            return skip("its indices are not in the file");
        }
        LIMN_TRY(read_positions());
        LIMN_TRY(read_triangles());
        if (!strokes()) {
            LIMN_TRY(read("NORMAL", result_.normals));
            LIMN_TRY(read("TANGENT", result_.tangents));
        }
        LIMN_TRY(read("TEXCOORD_0", result_.uvs));
        LIMN_TRY(read("TEXCOORD_1", result_.uvs1));
        LIMN_TRY(read_colors());
        LIMN_TRY(read_deformations());
        if (result_.indices.empty()) {
            return skip(
                strokes() ? "it has no point or line" : "all of its triangles are degenerate");
        }
        complete();
        return std::optional(std::move(result_));
    }

  private:
    /// The index of its accessor, or -1.
    [[nodiscard]] int find_attribute(const char* name) const {
        const auto found = source_.attributes.find(name);
        return found != source_.attributes.end() ? found->second : -1;
    }

    /// Whether anything is stored; all zeros otherwise, as where an extension has the data.
    [[nodiscard]] bool has_data(int accessor) const {
        const tinygltf::Accessor& source = item_at(document_.model.accessors, accessor);
        return source.bufferView >= 0 || source.sparse.isSparse;
    }

    Result<std::optional<MeshData>> skip(std::string_view why) {
        document_.warnings.push_back(fmt::format("{} is ignored: {}", place_, why));
        return std::optional<MeshData>();
    }

    Status read_positions() {
        const std::string place = place_ + ".attributes.POSITION";
        const std::vector<float> values =
            LIMN_TRY(read_floats(document_, find_attribute("POSITION"), 3, place));
        positions_.resize(values.size() / 3);
        std::memcpy(positions_.data(), values.data(), values.size() * sizeof(float));
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (std::abs(values[i]) > kLargestPosition) {
                return fail(
                    "{}: found {} in element {}, expected at most {}", place, values[i], i / 3,
                    kLargestPosition);
            }
        }
        return Done{};
    }

    /// Fills the indices and, in `used_`, the vertices that they reference in order of appearance;
    /// of points and lines the normals, too.
    Status read_triangles() {
        std::vector<std::uint32_t> list;
        const std::string place = place_ + ".indices";
        if (source_.indices >= 0) {
            list = LIMN_TRY(read_indices(document_, source_.indices, place));
        } else {
            list.resize(positions_.size());
            std::iota(list.begin(), list.end(), 0u);
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i] >= positions_.size()) {
                return fail(
                    "{}: found {} at {}, expected an index below the {} vertices", place, list[i],
                    i, positions_.size());
            }
        }
        if (source_.mode == TINYGLTF_MODE_TRIANGLES && list.size() % 3 != 0) {
            return fail("{}: found {} indices, expected a multiple of 3", place, list.size());
        }
        if (strokes()) {
            stroke(list);
            return Done{};
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

    /// Points and lines, which have no triangles of their own.
    [[nodiscard]] bool strokes() const { return source_.mode < TINYGLTF_MODE_TRIANGLES; }

    void stroke(const std::vector<std::uint32_t>& list) {
        Strokes made = make_strokes(positions_, list, source_.mode);
        if (made.found > kMaxStrokes) {
            document_.warnings.push_back(fmt::format(
                "{}: {} of its {} {} are drawn", place_, kMaxStrokes, made.found,
                source_.mode == kGltfPoints ? "points" : "lines"));
        }
        used_ = std::move(made.sources);
        result_.indices = std::move(made.indices);
        result_.normals = std::move(made.normals);
        result_.positions = gather(positions_);
        for (std::size_t i = 0; i < used_.size(); ++i) {
            result_.positions[i] += made.offsets[i];
        }
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
        const int accessor = find_attribute(name);
        if (accessor < 0) {
            return Done{};
        }
        const std::string place = fmt::format("{}.attributes.{}", place_, name);
        const int width = static_cast<int>(T::length());
        const std::vector<float> values = LIMN_TRY(read_floats(document_, accessor, width, place));
        std::vector<T> all(values.size() / static_cast<std::size_t>(width));
        if (all.size() != positions_.size()) {
            return fail(
                "{}: found {} elements, expected as many as POSITION has, {}", place, all.size(),
                positions_.size());
        }
        std::memcpy(all.data(), values.data(), values.size() * sizeof(float));
        target = gather(all);
        return Done{};
    }

    Status read_colors() {
        const int accessor = find_attribute("COLOR_0");
        if (accessor < 0
            || item_at(document_.model.accessors, accessor).type == TINYGLTF_TYPE_VEC4) {
            return read("COLOR_0", result_.colors);
        }
        std::vector<Vec3> opaque;
        LIMN_TRY(read("COLOR_0", opaque));
        for (const Vec3& color : opaque) {
            result_.colors.emplace_back(color, 1.0f);
        }
        return Done{};
    }

    Status read_deformations() {
        const GltfVertices vertices{source_, place_, positions_.size(), used_};
        if (joints_ > 0) {
            result_.skin = LIMN_TRY(read_skin_weights(document_, vertices, joints_));
        }
        // Most exporters write the names of the targets there.
        result_.morphs = LIMN_TRY(
            read_morph_targets(document_, vertices, extras_of(document_, "meshes", mesh_)));
        if (strokes()) {
            for (MorphTarget& morph : result_.morphs) {
                morph.normals.clear();
            }
        }
        result_.regions = LIMN_TRY(read_regions(document_, vertices));
        return Done{};
    }

    /// The set of texture coordinates that the normal map uses, if the mesh has it.
    [[nodiscard]] int tangent_uv_set() const {
        if (source_.material < 0 || result_.uvs1.empty()) {
            return 0;
        }
        const tinygltf::NormalTextureInfo& map =
            item_at(document_.model.materials, source_.material).normalTexture;
        const tinygltf::Value& own =  // overrides the map's
            member_of(extension_of(map.extensions, "KHR_texture_transform"), "texCoord");
        return (own.IsNumber() ? own.GetNumberAsInt() : map.texCoord) == 1 ? 1 : 0;
    }

    void complete() {
        if (result_.uvs.empty()) {
            result_.uvs.assign(result_.positions.size(), Vec2(0));
        }
        if (result_.normals.empty()) {
            // Existing tangents and morph normals would not match the new normals.
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
            if (strokes()) {  // what is found without uvs; both ends of a triangle have the same
                for (const Vec3& normal : result_.normals) {
                    result_.tangents.emplace_back(any_perpendicular(normal), 1.0f);
                }
            } else {
                generate_tangents(result_, tangent_uv_set());
            }
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
    std::size_t joints_;  ///< of its skin
    std::string place_;
    std::vector<Vec3> positions_;      ///< all of the accessor
    std::vector<std::uint32_t> used_;  ///< the vertex of the file of each vertex of the result
    MeshData result_;
};

}  // namespace

Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive, std::size_t joints) {
    return MeshBuilder(document, mesh, primitive, joints).build();
}

}  // namespace limn
