#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_document.h"
#include "content/load/gltf/gltf_strokes.h"
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
          where_(fmt::format("{}: meshes[{}].primitives[{}]", document.file, mesh, primitive)) {
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
        if (positions_.empty()) {
            return skip("it has no vertices");
        }
        LIMN_TRY(read_triangles());
        if (!strokes()) {
            read("NORMAL", result_.normals, Vec3(0), "recomputed");
            read("TANGENT", result_.tangents, Vec4(0), "recomputed");
        }
        read("TEXCOORD_0", result_.uvs, Vec2(0), "0");
        read("TEXCOORD_1", result_.uvs1, Vec2(0), "0");
        read_colors();
        LIMN_TRY(read_deformations());
        if (result_.indices.empty()) {
            return skip(strokes() ? "it has no point or line" : "it has no triangle with an area");
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

    /// Whether data is stored; otherwise all elements are zero, for example because an extension
    /// has the data.
    [[nodiscard]] bool has_data(int accessor) const {
        const tinygltf::Accessor& source = item_at(document_.model.accessors, accessor);
        return source.bufferView >= 0 || source.sparse.isSparse;
    }

    Result<std::optional<MeshData>> skip(std::string_view why) {
        document_.warnings.push_back(fmt::format("{} is ignored: {}", where_, why));
        return std::optional<MeshData>();
    }

    template <typename T>
    static std::vector<T> as_vectors(const std::vector<float>& values) {
        std::vector<T> all(values.size() / static_cast<std::size_t>(T::length()));
        if (!all.empty()) {
            std::memcpy(all.data(), values.data(), values.size() * sizeof(float));
        }
        return all;
    }

    Status read_positions() {
        const std::string where = where_ + ".attributes.POSITION";
        positions_ = as_vectors<Vec3>(
            LIMN_TRY(read_any_floats(document_, find_attribute("POSITION"), 3, where)));
        return Done{};
    }

    /// Fails where a position that is used is out of range; warns of those that are not finite.
    Status check_used(const std::vector<std::uint32_t>& list) {
        const std::string where = where_ + ".attributes.POSITION";
        std::size_t count = 0;
        for (const std::uint32_t index : list) {
            const Vec3& position = positions_[index];
            const float largest =
                std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)});
            if (is_finite(position) && largest > kLargestPosition) {
                return fail(
                    "{}: found {} in element {}, expected at most {}", where, largest, index,
                    kLargestPosition);
            }
            if (!is_finite(position) && count++ == 0) {
                document_.warnings.push_back(fmt::format(
                    "{}: found ({}, {}, {}) in element {}, expected finite numbers; what uses such "
                    "elements is left out",
                    where, position.x, position.y, position.z, index));
            }
        }
        return Done{};
    }

    /// Fills the indices and, in `used_`, the vertices that they reference in order of appearance;
    /// of points and lines the normals, too.
    Status read_triangles() {
        std::vector<std::uint32_t> list;
        const std::string where = where_ + ".indices";
        if (source_.indices >= 0) {
            list = LIMN_TRY(read_indices(document_, source_.indices, where));
        } else {
            list.resize(positions_.size());
            std::iota(list.begin(), list.end(), 0u);
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (list[i] >= positions_.size()) {
                return fail(
                    "{}: found {} at {}, expected an index below the {} vertices", where, list[i],
                    i, positions_.size());
            }
        }
        if (source_.mode == TINYGLTF_MODE_TRIANGLES && list.size() % 3 != 0) {
            document_.warnings.push_back(fmt::format(
                "{}: found {} indices, expected a multiple of 3; the last are left out", where,
                list.size()));
            list.resize(list.size() / 3 * 3);
        }
        LIMN_TRY(check_used(list));
        if (strokes()) {
            stroke(list);
            return Done{};
        }
        result_.indices = drop_bad_triangles(make_triangles(list, source_.mode));
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

    [[nodiscard]] std::vector<std::uint32_t>
    drop_bad_triangles(const std::vector<std::uint32_t>& corners) const {
        std::vector<std::uint32_t> kept;
        kept.reserve(corners.size());
        for (auto corner = corners.begin(); corner != corners.end(); corner += 3) {
            if (std::all_of(corner, corner + 3, [&](std::uint32_t index) {
                    return is_finite(positions_[index]);
                })) {
                kept.insert(kept.end(), corner, corner + 3);
            }
        }
        return kept;
    }

    /// Whether the primitive is points or lines, which have no triangles.
    [[nodiscard]] bool strokes() const { return source_.mode < TINYGLTF_MODE_TRIANGLES; }

    void stroke(const std::vector<std::uint32_t>& list) {
        Strokes made = make_strokes(positions_, list, source_.mode);
        if (made.found > kMaxStrokes) {
            document_.warnings.push_back(fmt::format(
                "{}: {} of its {} {} are drawn", where_, kMaxStrokes, made.found,
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

    /// The attribute `name`, for the vertices in use; empty when the file has none, or a bad one.
    /// Elements that are not finite, and directions without length, become `fallback`.
    template <typename T>
    void read(const char* name, std::vector<T>& target, T fallback, std::string_view cost) {
        const int accessor = find_attribute(name);
        if (accessor < 0) {
            return;
        }
        const std::string where = fmt::format("{}.attributes.{}", where_, name);
        Result<std::vector<T>> all = read_all<T>(accessor, where);
        if (!all) {
            warn_of_loss(document_, all.error(), "it is left out");
            return;
        }
        target = gather(*all);
        std::size_t count = 0;
        for (std::size_t i = 0; i < target.size(); ++i) {
            bool is_good = is_finite(target[i]);
            if constexpr (T::length() > 2) {  // of a color, too, that is black
                is_good = is_good && (fallback != T(0) || has_direction(Vec3(target[i])));
            }
            if (!is_good) {
                if (count++ == 0) {
                    document_.warnings.push_back(fmt::format(
                        "{}: found {} in element {}, expected {}; such elements are {}", where,
                        is_finite(target[i]) ? "a vector of length 0" : "NaN or infinity", used_[i],
                        is_finite(target[i]) ? "1" : "finite numbers", cost));
                }
                target[i] = fallback;
            }
        }
    }

    template <typename T>
    Result<std::vector<T>> read_all(int accessor, const std::string& where) {
        std::vector<T> all = as_vectors<T>(
            LIMN_TRY(read_any_floats(document_, accessor, static_cast<int>(T::length()), where)));
        if (all.size() != positions_.size()) {
            return fail(
                "{}: found {} elements, expected as many as POSITION has, {}", where, all.size(),
                positions_.size());
        }
        return all;
    }

    static bool has_direction(const Vec3& vector) {
        return normalize_or(vector, Vec3(0)) != Vec3(0);
    }

    void read_colors() {
        const int accessor = find_attribute("COLOR_0");
        if (accessor < 0
            || item_at(document_.model.accessors, accessor).type == TINYGLTF_TYPE_VEC4) {
            read("COLOR_0", result_.colors, Vec4(1), "white");
            return;
        }
        std::vector<Vec3> opaque;
        read("COLOR_0", opaque, Vec3(1), "white");
        for (const Vec3& color : opaque) {
            result_.colors.emplace_back(color, 1.0f);
        }
    }

    Status read_deformations() {
        const GltfVertices vertices{source_, where_, positions_.size(), used_};
        if (joints_ > 0) {
            Result<SkinWeights> skin = read_skin_weights(document_, vertices, joints_);
            if (skin) {
                result_.skin = *std::move(skin);
            } else {
                warn_of_loss(document_, skin.error(), "it is drawn without its skin");
            }
        }
        // Most exporters write the names of the targets there.
        result_.morphs = LIMN_TRY(
            read_morph_targets(document_, vertices, extras_of(document_, "meshes", mesh_)));
        if (strokes()) {
            for (MorphTarget& morph : result_.morphs) {
                morph.normals.clear();
            }
        }
        drop_bad_morph_normals();
        result_.regions = LIMN_TRY(read_regions(document_, vertices));
        return Done{};
    }

    void drop_bad_morph_normals() {
        for (std::size_t i = 0; i < result_.morphs.size(); ++i) {
            MorphTarget& morph = result_.morphs[i];
            const auto bad = std::ranges::find_if(morph.normals, [](const Vec3& normal) {
                return !std::isfinite(glm::dot(normal, normal));
            });
            if (bad != morph.normals.end()) {
                const auto at = static_cast<std::size_t>(bad - morph.normals.begin());
                document_.warnings.push_back(fmt::format(
                    "{}.targets[{}].NORMAL: found NaN or infinity in element {}, expected finite "
                    "numbers; its normals are recomputed",
                    where_, i, used_[morph.vertices[at]]));
                morph.normals.clear();
                lost_morph_normals_.push_back(i);
            }
        }
    }

    /// Recomputes normals only for targets that lost theirs.
    void remake_morph_normals() {
        std::vector<std::size_t> without;
        for (std::size_t i = 0; i < result_.morphs.size(); ++i) {
            const bool is_lost =
                std::ranges::find(lost_morph_normals_, i) != lost_morph_normals_.end();
            if (result_.morphs[i].normals.empty() && !is_lost) {
                without.push_back(i);
                result_.morphs[i].normals.resize(result_.morphs[i].vertices.size());
            }
        }
        generate_morph_normals(result_);
        for (const std::size_t i : without) {
            result_.morphs[i].normals.clear();
        }
    }

    /// Normals of length 0 are replaced by the area-weighted normals of their triangles.
    void remake_normals() {
        if (std::ranges::all_of(result_.normals, has_direction)) {
            return;
        }
        std::vector<Vec3> sums(result_.normals.size(), Vec3(0));
        for (std::size_t i = 0; i + 2 < result_.indices.size(); i += 3) {
            const std::uint32_t* const corners = &result_.indices[i];
            const Vec3& a = result_.positions[corners[0]];
            const Vec3 area =
                glm::cross(result_.positions[corners[1]] - a, result_.positions[corners[2]] - a);
            for (int corner = 0; corner < 3; ++corner) {
                sums[corners[corner]] += area;
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            if (!has_direction(result_.normals[i])) {
                result_.normals[i] = normalize_or(sums[i], Vec3(0, 1, 0));
            }
        }
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
        if (std::ranges::none_of(result_.normals, has_direction)) {
            // Existing tangents and morph normals would not match the new normals.
            result_.tangents.clear();
            for (MorphTarget& morph : result_.morphs) {
                morph.normals.clear();
            }
            result_.normals.clear();
            generate_normals(result_, kCreaseAngle);
            generate_morph_normals(result_);
        } else if (!lost_morph_normals_.empty()) {
            remake_morph_normals();
        }
        remake_normals();
        for (Vec3& normal : result_.normals) {
            normal = normalize_or(normal, Vec3(0, 1, 0));
        }
        if (std::ranges::any_of(
                result_.tangents, [](const Vec4& t) { return !has_direction(Vec3(t)); })) {
            result_.tangents.clear();
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
    std::string where_;
    std::vector<Vec3> positions_;      ///< all of the accessor
    std::vector<std::uint32_t> used_;  ///< the vertex of the file of each vertex of the result
    std::vector<std::size_t> lost_morph_normals_;  ///< numbers of targets
    MeshData result_;
};

}  // namespace

Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive, std::size_t joints) {
    return MeshBuilder(document, mesh, primitive, joints).build();
}

}  // namespace limn
