#include "content/load/gltf_write.h"

#include "content/load/atomic_file.h"
#include "content/load/gltf_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace limn {

namespace {

/// Bytes that the 32 bit sizes of a GLB can count.
constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kInfluences = 4;  ///< per vertex of one set

/// How a type is stored.
template <typename T>
struct Stored;
template <>
struct Stored<float> {
    static constexpr const char* kType = "SCALAR";
    static constexpr int kComponent = kGltfFloat;
};
template <>
struct Stored<std::uint32_t> {
    static constexpr const char* kType = "SCALAR";
    static constexpr int kComponent = kGltfUnsignedInt;
};
template <>
struct Stored<Vec2> {
    static constexpr const char* kType = "VEC2";
    static constexpr int kComponent = kGltfFloat;
};
template <>
struct Stored<Vec3> {
    static constexpr const char* kType = "VEC3";
    static constexpr int kComponent = kGltfFloat;
};
template <>
struct Stored<Vec4> {
    static constexpr const char* kType = "VEC4";
    static constexpr int kComponent = kGltfFloat;
};
template <>
struct Stored<std::array<std::uint16_t, kInfluences>> {
    static constexpr const char* kType = "VEC4";
    static constexpr int kComponent = kGltfUnsignedShort;
};
template <>
struct Stored<Mat4> {
    static constexpr const char* kType = "MAT4";
    static constexpr int kComponent = kGltfFloat;
};

JsonValue json_index(std::size_t index) {
    return json_of(static_cast<std::uint64_t>(index));
}

void set(JsonValue& object, std::string_view key, JsonValue value) {
    object.members.push_back({std::string(key), {}, std::move(value)});
}

/// By name of the driven target; see read_morph_targets.
JsonValue drivers_of(const std::vector<MorphTarget>& targets) {
    JsonValue all = json_object();
    for (const MorphTarget& target : targets) {
        JsonValue drivers = json_array();
        for (const ShapeDriver& driver : target.drivers) {
            JsonValue one = json_object();
            set(one, "target", json_of(targets[driver.target].name));
            set(one, "peak", json_of(driver.peak));
            drivers.items.push_back(std::move(one));
        }
        if (!drivers.items.empty()) {
            set(all, target.name, std::move(drivers));
        }
    }
    return all;
}

template <typename T>
JsonValue json_vector(const T& vector) {
    JsonValue array = json_array();
    for (int i = 0; i < static_cast<int>(T::length()); ++i) {
        array.items.push_back(json_of(vector[i]));
    }
    return array;
}

std::string in_capitals(std::string_view name) {
    std::string capitals(name);
    for (char& letter : capitals) {
        letter = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    }
    return capitals;
}

bool is_region_name(std::string_view name) {
    return !name.empty()
           && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == name.npos;
}

class GlbWriter {
  public:
    explicit GlbWriter(const GltfScene& scene) : scene_(scene) {}

    Result<std::vector<std::byte>> write() {
        LIMN_TRY(check());
        number_nodes();
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            LIMN_TRY(add_node(i));
        }
        for (const SkinData& skin : scene_.skins) {
            LIMN_TRY(add_skin(skin));
        }
        for (const Material& material : scene_.materials) {
            LIMN_TRY(add_material(material));
        }
        for (const ClipData& clip : scene_.clips) {
            LIMN_TRY(add_clip(clip));
        }
        return pack();
    }

  private:
    Status check() const {
        if (!scene_.images.empty()) {
            return fail(
                "{}: found {} images, expected none: they are not written", scene_.name,
                scene_.images.size());
        }
        for (const GltfNode& node : scene_.nodes) {
            if (node.has_camera || node.light.index() != 0 || !node.components.empty()) {
                return fail(
                    "{}: found a camera, light or component on the node {}, expected none: they "
                    "are not written",
                    scene_.name, in_quotes(node.name));
            }
        }
        return Done{};
    }

    // ---- bytes ----------------------------------------------------------------------------------

    template <typename T>
    std::size_t add_view(std::span<const T> values) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + (values.size_bytes() + 3) / 4 * 4);
        std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
        JsonValue view = json_object();
        set(view, "buffer", json_index(0));
        set(view, "byteOffset", json_index(at));
        set(view, "byteLength", json_index(values.size_bytes()));
        views_.items.push_back(std::move(view));
        return views_.items.size() - 1;
    }

    template <typename T>
    static JsonValue make_accessor(std::size_t count) {
        JsonValue accessor = json_object();
        set(accessor, "componentType", json_index(Stored<T>::kComponent));
        set(accessor, "count", json_index(count));
        set(accessor, "type", json_of(std::string_view(Stored<T>::kType)));
        return accessor;
    }

    JsonValue add(JsonValue accessor) {
        accessors_.items.push_back(std::move(accessor));
        return json_index(accessors_.items.size() - 1);
    }

    /// The index of an accessor with these values.
    template <typename T>
    JsonValue add_values(const std::vector<T>& values) {
        JsonValue accessor = make_accessor<T>(values.size());
        set(accessor, "bufferView", json_index(add_view(std::span(values))));
        return add(std::move(accessor));
    }

    /// A view of sparse indices, in the smallest type that holds `count`.
    JsonValue add_sparse_indices(const std::vector<std::uint32_t>& vertices, std::size_t count) {
        JsonValue indices = json_object();
        if (count > std::numeric_limits<std::uint16_t>::max()) {
            set(indices, "bufferView",
                json_index(add_view(std::span<const std::uint32_t>(vertices))));
            set(indices, "componentType", json_index(kGltfUnsignedInt));
        } else {
            const std::vector<std::uint16_t> small(vertices.begin(), vertices.end());
            set(indices, "bufferView", json_index(add_view(std::span(small))));
            set(indices, "componentType", json_index(kGltfUnsignedShort));
        }
        return indices;
    }

    /// The index of an accessor of `count` elements, 0 but for `values` where `indices` says.
    template <typename T>
    JsonValue
    add_sparse(std::size_t count, const JsonValue& indices, const std::vector<T>& values) {
        JsonValue accessor = make_accessor<T>(count);
        add_sparse_values(accessor, indices, values);
        return add(std::move(accessor));
    }

    template <typename T>
    void
    add_sparse_values(JsonValue& accessor, const JsonValue& indices, const std::vector<T>& values) {
        if (values.empty()) {
            return;
        }
        JsonValue source = json_object();
        set(source, "bufferView", json_index(add_view(std::span(values))));
        JsonValue sparse = json_object();
        set(sparse, "count", json_index(values.size()));
        set(sparse, "indices", indices);
        set(sparse, "values", std::move(source));
        set(accessor, "sparse", std::move(sparse));
    }

    // ---- meshes ---------------------------------------------------------------------------------

    /// The index of the mesh with all parts of a node.
    Result<JsonValue> add_mesh(const GltfNode& node) {
        JsonValue primitives = json_array();
        for (const GltfPart& part : node.parts) {
            primitives.items.push_back(
                LIMN_TRY(make_primitive(scene_.meshes[part.mesh], part.material)));
        }
        const MeshData& first = scene_.meshes[node.parts[0].mesh];
        JsonValue mesh = json_object();
        set(mesh, "name", json_of(node.parts.size() == 1 ? first.name : node.name));
        set(mesh, "primitives", std::move(primitives));
        if (!first.morphs.empty()) {
            JsonValue names = json_array();
            JsonValue units = json_array();
            bool has_units = false;
            for (const MorphTarget& morph : first.morphs) {
                names.items.push_back(json_of(morph.name));
                units.items.push_back(json_of(morph.action_unit));
                has_units = has_units || !morph.action_unit.empty();
            }
            JsonValue extras = json_object();
            set(extras, "targetNames", std::move(names));
            if (has_units) {
                set(extras, "actionUnits", std::move(units));
            }
            if (JsonValue drivers = drivers_of(first.morphs); !drivers.members.empty()) {
                set(extras, "targetDrivers", std::move(drivers));
            }
            set(mesh, "extras", std::move(extras));
        }
        meshes_.items.push_back(std::move(mesh));
        return json_index(meshes_.items.size() - 1);
    }

    Result<JsonValue> make_primitive(const MeshData& mesh, std::uint32_t material) {
        JsonValue attributes = json_object();
        JsonValue positions = make_accessor<Vec3>(mesh.positions.size());
        set(positions, "bufferView", json_index(add_view(std::span<const Vec3>(mesh.positions))));
        set_extent(positions, mesh.positions, false);
        set(attributes, "POSITION", add(std::move(positions)));
        add_attribute(attributes, "NORMAL", mesh.normals);
        add_attribute(attributes, "TANGENT", mesh.tangents);
        add_attribute(attributes, "TEXCOORD_0", mesh.uvs);
        add_attribute(attributes, "TEXCOORD_1", mesh.uvs1);
        add_attribute(attributes, "COLOR_0", mesh.colors);
        add_influences(attributes, mesh.skin);
        for (const VertexRegion& region : mesh.regions) {
            LIMN_TRY(add_region(attributes, region, mesh));
        }
        JsonValue primitive = json_object();
        set(primitive, "attributes", std::move(attributes));
        set(primitive, "indices", add_values(mesh.indices));
        set(primitive, "material", json_index(material));
        if (!mesh.morphs.empty()) {
            JsonValue targets = json_array();
            for (const MorphTarget& morph : mesh.morphs) {
                targets.items.push_back(make_target(morph, mesh.positions.size()));
            }
            set(primitive, "targets", std::move(targets));
        }
        return primitive;
    }

    template <typename T>
    void add_attribute(JsonValue& attributes, std::string_view name, const std::vector<T>& values) {
        if (!values.empty()) {
            set(attributes, name, add_values(values));
        }
    }

    /// Sets the smallest and largest values, as glTF wants for positions; with those of vertices
    /// that stay where they are if `with_zero`.
    static void set_extent(JsonValue& accessor, const std::vector<Vec3>& values, bool with_zero) {
        Bounds box;
        if (with_zero || values.empty()) {
            grow(box, Vec3(0));
        }
        for (const Vec3& value : values) {
            grow(box, value);
        }
        set(accessor, "min", json_vector(box.min));
        set(accessor, "max", json_vector(box.max));
    }

    JsonValue make_target(const MorphTarget& morph, std::size_t count) {
        const JsonValue indices =
            morph.vertices.empty() ? JsonValue{} : add_sparse_indices(morph.vertices, count);
        JsonValue target = json_object();
        JsonValue positions = make_accessor<Vec3>(count);
        add_sparse_values(positions, indices, morph.positions);
        set_extent(positions, morph.positions, morph.vertices.size() < count);
        set(target, "POSITION", add(std::move(positions)));
        if (!morph.normals.empty()) {
            set(target, "NORMAL", add_sparse(count, indices, morph.normals));
        }
        if (!morph.tangents.empty()) {
            set(target, "TANGENT", add_sparse(count, indices, morph.tangents));
        }
        return target;
    }

    /// As many sets of four as the vertex with most influences needs.
    void add_influences(JsonValue& attributes, const SkinWeights& skin) {
        if (skin.empty()) {
            return;
        }
        const std::size_t count = skin.first.size() - 1;
        std::size_t most = 1;
        for (std::size_t v = 0; v < count; ++v) {
            most = std::max<std::size_t>(most, skin.first[v + 1] - skin.first[v]);
        }
        for (std::size_t n = 0; n * kInfluences < most; ++n) {
            std::vector<std::array<std::uint16_t, kInfluences>> joints(count);
            std::vector<Vec4> weights(count, Vec4(0));
            for (std::size_t v = 0; v < count; ++v) {
                for (std::size_t k = 0; k < kInfluences; ++k) {
                    const std::size_t i = skin.first[v] + n * kInfluences + k;
                    if (i < skin.first[v + 1]) {
                        joints[v][k] = skin.joints[i];
                        weights[v][static_cast<int>(k)] = skin.weights[i];
                    }
                }
            }
            set(attributes, format_text("JOINTS_{}", n), add_values(joints));
            set(attributes, format_text("WEIGHTS_{}", n), add_values(weights));
        }
    }

    Status add_region(JsonValue& attributes, const VertexRegion& region, const MeshData& mesh) {
        if (!is_region_name(region.name)) {
            return fail(
                "{}: found the region {}, expected a name of a-z, 0-9 and _", scene_.name,
                in_quotes(region.name));
        }
        const std::size_t count = mesh.positions.size();
        std::vector<std::uint32_t> vertices;
        std::vector<float> weights;
        std::vector<Vec3> across;
        for (std::uint32_t v = 0; v < count; ++v) {
            if (region.weights[v] > 0) {
                vertices.push_back(v);
                weights.push_back(region.weights[v]);
                across.push_back(region.across.empty() ? Vec3(0) : region.across[v]);
            }
        }
        const JsonValue indices =
            vertices.empty() ? JsonValue{} : add_sparse_indices(vertices, count);
        const std::string name = in_capitals(region.name);
        set(attributes, "_REGION_" + name, add_sparse(count, indices, weights));
        if (!region.across.empty()) {
            set(attributes, "_ACROSS_" + name, add_sparse(count, indices, across));
        }
        return Done{};
    }

    // ---- nodes, skins, materials ----------------------------------------------------------------

    /// A node "x.skin" with a skin is written as the mesh of the node x, as the loader made it.
    void number_nodes() {
        std::map<std::string_view, std::size_t> bare;
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (scene_.nodes[i].parts.empty()) {
                bare.try_emplace(scene_.nodes[i].name, i);
            }
        }
        constexpr std::string_view kEnding = ".skin";
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            const GltfNode& node = scene_.nodes[i];
            std::string_view name = node.name;
            if (node.skin >= 0 && name.ends_with(kEnding)) {
                name.remove_suffix(kEnding.size());
                const auto place = bare.find(name);
                if (place != bare.end()) {
                    skinned_[place->second] = i;
                    merged_.insert(i);
                }
            }
        }
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            number_.push_back(
                i
                - static_cast<std::size_t>(std::distance(merged_.begin(), merged_.lower_bound(i))));
        }
    }

    Status add_node(std::size_t index) {
        if (merged_.contains(index)) {
            return Done{};
        }
        const GltfNode& source = scene_.nodes[index];
        JsonValue node = json_object();
        if (!source.name.empty()) {
            set(node, "name", json_of(source.name));
        }
        const Transform& transform = source.transform;
        if (transform.position != Vec3(0)) {
            set(node, "translation", json_vector(transform.position));
        }
        if (const Quat& q = transform.rotation; q != Quat(1, 0, 0, 0)) {
            set(node, "rotation", json_vector(Vec4(q.x, q.y, q.z, q.w)));
        }
        if (transform.scale != Vec3(1)) {
            set(node, "scale", json_vector(transform.scale));
        }
        JsonValue children = json_array();
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (scene_.nodes[i].parent == static_cast<std::int32_t>(index)) {
                children.items.push_back(json_index(number_[i]));
            }
        }
        if (!children.items.empty()) {
            set(node, "children", std::move(children));
        }
        const auto skinned = skinned_.find(index);
        LIMN_TRY(
            add_parts(node, scene_.nodes[skinned == skinned_.end() ? index : skinned->second]));
        if (source.parent < 0) {
            roots_.items.push_back(json_index(number_[index]));
        }
        nodes_.items.push_back(std::move(node));
        return Done{};
    }

    Status add_parts(JsonValue& node, const GltfNode& source) {
        if (source.parts.empty()) {
            return Done{};
        }
        set(node, "mesh", LIMN_TRY(add_mesh(source)));
        if (source.skin >= 0) {
            set(node, "skin", json_index(static_cast<std::size_t>(source.skin)));
        }
        if (source.first_morph >= 0) {
            JsonValue weights = json_array();
            const std::size_t count = scene_.meshes[source.parts[0].mesh].morphs.size();
            for (std::size_t i = 0; i < count; ++i) {
                weights.items.push_back(json_of(
                    scene_.morph_weights[static_cast<std::size_t>(source.first_morph) + i]));
            }
            set(node, "weights", std::move(weights));
        }
        return Done{};
    }

    /// The first node of each joint.
    [[nodiscard]] std::map<std::int32_t, std::size_t> find_joint_nodes() const {
        std::map<std::int32_t, std::size_t> node_of_joint;
        for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
            node_of_joint.try_emplace(scene_.joints[i], i);
        }
        return node_of_joint;
    }

    Status add_clip(const ClipData& source) {
        const std::map<std::int32_t, std::size_t> node_of_joint = find_joint_nodes();
        JsonValue samplers = json_array();
        JsonValue channels = json_array();
        for (const ClipSheet& sheet : source.sheets) {
            if (sheet.interpolation != Interpolation::Linear || !sheet.rotating.empty()
                || !sheet.scaling.empty() || !sheet.morphing.empty() || sheet.times.empty()) {
                return fail(
                    "{}: found other keys in the clip {}, expected linear translations only",
                    scene_.name, in_quotes(source.name));
            }
            JsonValue times = make_accessor<float>(sheet.times.size());
            set(times, "bufferView", json_index(add_view(std::span(sheet.times))));
            set(times, "min", json_array({json_of(sheet.times.front())}));
            set(times, "max", json_array({json_of(sheet.times.back())}));
            const JsonValue input = add(std::move(times));
            const std::size_t joints = sheet.translating.size();
            for (std::size_t j = 0; j < joints; ++j) {
                const auto node = node_of_joint.find(sheet.translating[j]);
                if (node == node_of_joint.end()) {
                    return fail(
                        "{}: found joint {} in the clip {}, expected one with a node", scene_.name,
                        sheet.translating[j], in_quotes(source.name));
                }
                std::vector<Vec3> places;
                for (std::size_t k = 0; k < sheet.times.size(); ++k) {
                    places.push_back(sheet.translations[k * joints + j]);
                }
                JsonValue target = json_object();
                set(target, "node", json_index(number_[node->second]));
                set(target, "path", json_of(std::string_view("translation")));
                JsonValue channel = json_object();
                set(channel, "sampler", json_index(samplers.items.size()));
                set(channel, "target", std::move(target));
                channels.items.push_back(std::move(channel));
                JsonValue sampler = json_object();
                set(sampler, "input", input);
                set(sampler, "output", add_values(places));
                samplers.items.push_back(std::move(sampler));
            }
        }
        JsonValue clip = json_object();
        set(clip, "name", json_of(source.name));
        set(clip, "samplers", std::move(samplers));
        set(clip, "channels", std::move(channels));
        animations_.items.push_back(std::move(clip));
        return Done{};
    }

    Status add_skin(const SkinData& source) {
        const std::map<std::int32_t, std::size_t> node_of_joint = find_joint_nodes();
        JsonValue joints = json_array();
        std::vector<Mat4> matrices;
        for (std::size_t i = 0; i < source.joints.size(); ++i) {
            const auto node = node_of_joint.find(source.joints[i]);
            if (node == node_of_joint.end()) {
                return fail(
                    "{}: found joint {} in the skin {}, expected one with a node", scene_.name,
                    source.joints[i], in_quotes(source.name));
            }
            joints.items.push_back(json_index(number_[node->second]));
            matrices.push_back(to_mat4(source.joint_from_mesh[i]));
        }
        JsonValue skin = json_object();
        set(skin, "name", json_of(source.name));
        set(skin, "joints", std::move(joints));
        set(skin, "inverseBindMatrices", add_values(matrices));
        skins_.items.push_back(std::move(skin));
        return Done{};
    }

    Status add_material(const Material& source) {
        if (source.shading != ShadingModel::Pbr && source.shading != ShadingModel::Unlit) {
            return fail(
                "{}: found another shading model on the material {}, expected pbr or unlit",
                scene_.name, in_quotes(source.name));
        }
        JsonValue pbr = json_object();
        set(pbr, "baseColorFactor", json_vector(source.base_color));
        set(pbr, "metallicFactor", json_of(source.metalness));
        set(pbr, "roughnessFactor", json_of(source.roughness));
        JsonValue material = json_object();
        set(material, "name", json_of(source.name));
        set(material, "pbrMetallicRoughness", std::move(pbr));
        JsonValue extensions = json_object();
        const float strength =
            std::max({source.emission.x, source.emission.y, source.emission.z, 1.0f});
        if (source.emission != Vec3(0)) {
            set(material, "emissiveFactor", json_vector(source.emission / strength));
        }
        if (strength > 1) {
            JsonValue emission = json_object();
            set(emission, "emissiveStrength", json_of(strength));
            use(extensions, "KHR_materials_emissive_strength", std::move(emission));
        }
        if (source.shading == ShadingModel::Unlit) {
            use(extensions, "KHR_materials_unlit", json_object());
        }
        if (!extensions.members.empty()) {
            set(material, "extensions", std::move(extensions));
        }
        if (source.alpha_mode != AlphaMode::Opaque) {
            const bool mask = source.alpha_mode == AlphaMode::Mask;
            set(material, "alphaMode", json_of(std::string_view(mask ? "MASK" : "BLEND")));
            if (mask) {
                set(material, "alphaCutoff", json_of(source.alpha_cutoff));
            }
        }
        if (source.double_sided) {
            set(material, "doubleSided", json_of(true));
        }
        materials_.items.push_back(std::move(material));
        return Done{};
    }

    void use(JsonValue& extensions, std::string_view name, JsonValue value) {
        set(extensions, name, std::move(value));
        used_extensions_.insert(std::string(name));
    }

    // ---- the file -------------------------------------------------------------------------------

    Result<std::vector<std::byte>> pack() {
        JsonValue asset = json_object();
        set(asset, "version", json_of(std::string_view("2.0")));
        set(asset, "generator", json_of(std::string_view("limn")));
        JsonValue scene = json_object();
        if (!roots_.items.empty()) {
            set(scene, "nodes", std::move(roots_));
        }
        JsonValue root = json_object();
        set(root, "asset", std::move(asset));
        set(root, "scene", json_index(0));
        set(root, "scenes", json_array({std::move(scene)}));
        if (!used_extensions_.empty()) {
            JsonValue used = json_array();
            for (const std::string& name : used_extensions_) {
                used.items.push_back(json_of(name));
            }
            set(root, "extensionsUsed", std::move(used));
        }
        for (auto& [key, list] :
             {std::pair<const char*, JsonValue*>{"nodes", &nodes_},
              {"meshes", &meshes_},
              {"materials", &materials_},
              {"skins", &skins_},
              {"animations", &animations_},
              {"accessors", &accessors_},
              {"bufferViews", &views_}}) {
            if (!list->items.empty()) {
                set(root, key, std::move(*list));
            }
        }
        return pack_glb(std::move(root), bytes_, scene_.name);
    }

    const GltfScene& scene_;
    std::vector<std::byte> bytes_;
    JsonValue views_ = json_array();
    JsonValue accessors_ = json_array();
    JsonValue meshes_ = json_array();
    JsonValue nodes_ = json_array();
    JsonValue skins_ = json_array();
    JsonValue animations_ = json_array();
    JsonValue materials_ = json_array();
    JsonValue roots_ = json_array();
    std::set<std::string> used_extensions_;
    std::vector<std::size_t> number_;             ///< in the file, of each node
    std::map<std::size_t, std::size_t> skinned_;  ///< node with the skinned mesh, by its place
    std::set<std::size_t> merged_;                ///< nodes that are written as another's mesh
};

void append(std::vector<std::byte>& file, std::span<const std::byte> bytes) {
    file.insert(file.end(), bytes.begin(), bytes.end());
}

void append_words(std::vector<std::byte>& file, std::initializer_list<std::uint32_t> words) {
    append(file, std::as_bytes(std::span(words.begin(), words.size())));
}

}  // namespace

Result<std::vector<std::byte>>
pack_glb(JsonValue root, std::span<const std::byte> bytes, const std::string& name) {
    std::erase_if(root.members, [](const JsonMember& member) { return member.key == "buffers"; });
    if (!bytes.empty()) {
        JsonValue buffer = json_object();
        set(buffer, "byteLength", json_index(bytes.size()));
        set(root, "buffers", json_array({std::move(buffer)}));
    }
    std::string json = write_json(root);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t size = 12 + 8 + json.size() + (bytes.empty() ? 0 : 8 + bytes.size());
    if (size > kMaxBytes) {
        return fail("{}: found {} bytes, expected at most {}", name, size, kMaxBytes);
    }
    std::vector<std::byte> file;
    file.reserve(size);
    append_words(file, {0x46546c67u, 2, static_cast<std::uint32_t>(size)});
    append_words(file, {static_cast<std::uint32_t>(json.size()), 0x4e4f534au});
    append(file, std::as_bytes(std::span(json)));
    if (!bytes.empty()) {
        append_words(file, {static_cast<std::uint32_t>(bytes.size()), 0x004e4942u});
        append(file, bytes);
    }
    return file;
}

Result<std::vector<std::byte>> write_glb(const GltfScene& scene) {
    return GlbWriter(scene).write();
}

Status save_glb(const std::string& path, const GltfScene& scene) {
    const std::vector<std::byte> bytes = LIMN_TRY(write_glb(scene));
    return write_file(path, bytes);
}

}  // namespace limn
