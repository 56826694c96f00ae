#include "content/load/gltf/gltf_write.h"

#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_file.h"
#include "content/load/gltf/gltf_freedoms.h"
#include "content/load/gltf/gltf_layers.h"
#include "content/load/gltf/gltf_material_extras.h"
#include "content/load/gltf/gltf_write_textures.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

namespace limn {

namespace {

constexpr std::size_t kInfluences = 4;  ///< per vertex of one set

/// TINYGLTF_TYPE_SCALAR, VEC2 to VEC4 or MAT4.
template <typename T>
constexpr int element_type() {
    if constexpr (std::is_arithmetic_v<T>) {
        return TINYGLTF_TYPE_SCALAR;
    } else {
        return std::is_same_v<T, Mat4> ? TINYGLTF_TYPE_MAT4 : static_cast<int>(T::length());
    }
}

/// float, 16 or 32 bits.
template <typename T>
constexpr int component_type() {
    if constexpr (!std::is_arithmetic_v<T>) {
        return component_type<typename T::value_type>();
    } else {
        return std::is_floating_point_v<T> ? TINYGLTF_COMPONENT_TYPE_FLOAT
               : sizeof(T) == 2            ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                           : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    }
}

template <typename T>
std::vector<double> numbers_of(const T& vector) {
    std::vector<double> numbers;
    for (int i = 0; i < static_cast<int>(T::length()); ++i) {
        numbers.push_back(vector[i]);
    }
    return numbers;
}

/// Targets that follow other targets, by name; see read_morph_targets.
tinygltf::Value::Object drivers_of(const std::vector<MorphTarget>& targets) {
    tinygltf::Value::Object all;
    for (const MorphTarget& target : targets) {
        tinygltf::Value::Array drivers;
        for (const ShapeDriver& driver : target.drivers) {
            drivers.emplace_back(tinygltf::Value::Object{
                {"target", tinygltf::Value(targets[driver.target].name)},
                {"peak", tinygltf::Value(static_cast<double>(driver.peak))}});
        }
        if (!drivers.empty()) {
            all.emplace(target.name, std::move(drivers));
        }
    }
    return all;
}

tinygltf::Value extras_of(const std::vector<MorphTarget>& targets) {
    tinygltf::Value::Array names;
    tinygltf::Value::Array units;
    bool has_units = false;
    for (const MorphTarget& morph : targets) {
        names.emplace_back(morph.name);
        units.emplace_back(morph.action_unit);
        has_units = has_units || !morph.action_unit.empty();
    }
    tinygltf::Value::Object extras;
    extras.emplace("targetNames", std::move(names));
    if (has_units) {
        extras.emplace("actionUnits", std::move(units));
    }
    if (tinygltf::Value::Object drivers = drivers_of(targets); !drivers.empty()) {
        extras.emplace("targetDrivers", std::move(drivers));
    }
    return tinygltf::Value(std::move(extras));
}

std::string in_capitals(std::string_view name) {
    std::string capitals(name);
    for (char& letter : capitals) {
        letter = letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    }
    return capitals;
}

/// Column `column` of rows with `width` values.
template <typename T>
std::vector<T> column_of(const std::vector<T>& rows, std::size_t width, std::size_t column) {
    std::vector<T> values;
    for (std::size_t i = column; i < rows.size(); i += width) {
        values.push_back(rows[i]);
    }
    return values;
}

/// The same in glTF's order of components, whatever GLM's is.
std::vector<Vec4>
quaternions_of(const std::vector<Quat>& rows, std::size_t width, std::size_t column) {
    std::vector<Vec4> values;
    for (const Quat& q : column_of(rows, width, column)) {
        values.emplace_back(q.x, q.y, q.z, q.w);
    }
    return values;
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
        LIMN_TRY(append_images(model_, scene_));
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
        model_.scenes.resize(roots_.empty() ? 0 : 1);  // one without nodes becomes null
        if (!roots_.empty()) {
            model_.scenes[0].nodes = std::move(roots_);
            model_.defaultScene = 0;
        }
        model_.asset.generator = "limn";
        model_.extensionsUsed.assign(extensions_.begin(), extensions_.end());
        return pack_model(model_, scene_.name);
    }

  private:
    Status check() const {
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
    int store(const std::vector<T>& values) {
        return append_accessor(
            model_, element_type<T>(), component_type<T>(), values.size(),
            std::as_bytes(std::span(values)));
    }

    /// The elements of a sparse accessor, shared by several.
    struct SparseIndices {
        int view = -1;
        int component = 0;
    };

    template <typename T>
    SparseIndices store_indices(const std::vector<T>& indices) {
        return {append_view(model_, std::as_bytes(std::span(indices))), component_type<T>()};
    }

    /// In the smallest type that holds `count`.
    SparseIndices
    add_sparse_indices(const std::vector<std::uint32_t>& vertices, std::size_t count) {
        if (vertices.empty() || count > std::numeric_limits<std::uint16_t>::max()) {
            return vertices.empty() ? SparseIndices{} : store_indices(vertices);
        }
        return store_indices(std::vector<std::uint16_t>(vertices.begin(), vertices.end()));
    }

    /// `count` elements, 0 but for `values` where `indices` says.
    template <typename T>
    int
    store_sparse(std::size_t count, const SparseIndices& indices, const std::vector<T>& values) {
        const int added =
            append_accessor(model_, element_type<T>(), component_type<T>(), count, {});
        if (!values.empty()) {
            const int view = append_view(model_, std::as_bytes(std::span(values)));
            auto& sparse = model_.accessors.back().sparse;
            sparse.isSparse = true;
            sparse.count = static_cast<int>(values.size());
            sparse.indices = {0, indices.view, indices.component};
            sparse.values = {view, 0};
        }
        return added;
    }

    // ---- meshes ---------------------------------------------------------------------------------

    /// The index of the mesh with all parts of a node.
    Result<int> add_mesh(const GltfNode& node) {
        const MeshData& first = scene_.meshes[node.parts[0].mesh];
        tinygltf::Mesh mesh;
        mesh.name = node.parts.size() == 1 ? first.name : node.name;
        for (const GltfPart& part : node.parts) {
            mesh.primitives.push_back(
                LIMN_TRY(make_primitive(scene_.meshes[part.mesh], part.material)));
        }
        if (!first.morphs.empty()) {
            mesh.extras = extras_of(first.morphs);
        }
        model_.meshes.push_back(std::move(mesh));
        return static_cast<int>(model_.meshes.size()) - 1;
    }

    Result<tinygltf::Primitive> make_primitive(const MeshData& mesh, std::uint32_t material) {
        tinygltf::Primitive primitive;
        primitive.attributes["POSITION"] = store(mesh.positions);
        set_extent(mesh.positions, false);
        add_attribute(primitive, "NORMAL", mesh.normals);
        add_attribute(primitive, "TANGENT", mesh.tangents);
        add_attribute(primitive, "TEXCOORD_0", mesh.uvs);
        add_attribute(primitive, "TEXCOORD_1", mesh.uvs1);
        add_attribute(primitive, "COLOR_0", mesh.colors);
        add_influences(primitive, mesh.skin);
        for (const VertexRegion& region : mesh.regions) {
            LIMN_TRY(add_region(primitive, region, mesh));
        }
        primitive.indices = store(mesh.indices);
        primitive.material = static_cast<int>(material);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        for (const MorphTarget& morph : mesh.morphs) {
            primitive.targets.push_back(make_target(morph, mesh.positions.size()));
        }
        return primitive;
    }

    template <typename T>
    void
    add_attribute(tinygltf::Primitive& primitive, const char* name, const std::vector<T>& values) {
        if (!values.empty()) {
            primitive.attributes[name] = store(values);
        }
    }

    /// Sets the smallest and largest values of the last accessor, as glTF wants for positions; with
    /// those of vertices that stay where they are if `with_zero`.
    void set_extent(const std::vector<Vec3>& values, bool with_zero) {
        Bounds box;
        if (with_zero || values.empty()) {
            grow(box, Vec3(0));
        }
        for (const Vec3& value : values) {
            grow(box, value);
        }
        model_.accessors.back().minValues = numbers_of(box.min);
        model_.accessors.back().maxValues = numbers_of(box.max);
    }

    std::map<std::string, int> make_target(const MorphTarget& morph, std::size_t count) {
        const SparseIndices indices = add_sparse_indices(morph.vertices, count);
        std::map<std::string, int> target;
        target["POSITION"] = store_sparse(count, indices, morph.positions);
        set_extent(morph.positions, morph.vertices.size() < count);
        if (!morph.normals.empty()) {
            target["NORMAL"] = store_sparse(count, indices, morph.normals);
        }
        if (!morph.tangents.empty()) {
            target["TANGENT"] = store_sparse(count, indices, morph.tangents);
        }
        return target;
    }

    /// Adds as many sets of four as the vertex with the most influences needs.
    void add_influences(tinygltf::Primitive& primitive, const SkinWeights& skin) {
        if (skin.empty()) {
            return;
        }
        const std::size_t count = skin.first.size() - 1;
        std::size_t most = 1;
        for (std::size_t v = 0; v < count; ++v) {
            most = std::max<std::size_t>(most, skin.first[v + 1] - skin.first[v]);
        }
        for (std::size_t n = 0; n * kInfluences < most; ++n) {
            std::vector<glm::u16vec4> joints(count, glm::u16vec4(0));
            std::vector<Vec4> weights(count, Vec4(0));
            for (std::size_t v = 0; v < count; ++v) {
                for (std::size_t k = 0; k < kInfluences; ++k) {
                    const std::size_t i = skin.first[v] + n * kInfluences + k;
                    if (i < skin.first[v + 1]) {
                        joints[v][static_cast<int>(k)] = skin.joints[i];
                        weights[v][static_cast<int>(k)] = skin.weights[i];
                    }
                }
            }
            primitive.attributes[format_text("JOINTS_{}", n)] = store(joints);
            primitive.attributes[format_text("WEIGHTS_{}", n)] = store(weights);
        }
    }

    Status
    add_region(tinygltf::Primitive& primitive, const VertexRegion& region, const MeshData& mesh) {
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
        const SparseIndices indices = add_sparse_indices(vertices, count);
        const std::string name = in_capitals(region.name);
        primitive.attributes["_REGION_" + name] = store_sparse(count, indices, weights);
        if (!region.across.empty()) {
            primitive.attributes["_ACROSS_" + name] = store_sparse(count, indices, across);
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
                const auto found = bare.find(name);
                if (found != bare.end()) {
                    skinned_[found->second] = i;
                    merged_.insert(i);
                }
            }
        }
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            number_.push_back(static_cast<int>(
                static_cast<std::ptrdiff_t>(i)
                - std::distance(merged_.begin(), merged_.lower_bound(i))));
        }
    }

    Status add_node(std::size_t index) {
        if (merged_.contains(index)) {
            return Done{};
        }
        const GltfNode& source = scene_.nodes[index];
        const Transform& transform = source.transform;
        const Quat& q = transform.rotation;
        tinygltf::Node node;
        node.name = source.name;
        // Unconditionally, as a node without any member becomes null.
        node.translation = numbers_of(transform.position);
        if (q != Quat(1, 0, 0, 0)) {
            node.rotation = {q.x, q.y, q.z, q.w};
        }
        if (transform.scale != Vec3(1)) {
            node.scale = numbers_of(transform.scale);
        }
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (scene_.nodes[i].parent == static_cast<std::int32_t>(index)) {
                node.children.push_back(number_[i]);
            }
        }
        if (index < scene_.joints.size() && scene_.joints[index] >= 0) {
            tinygltf::Value::Array limits = write_joint_limits(
                scene_.skeleton, static_cast<std::uint16_t>(scene_.joints[index]));
            if (!limits.empty()) {
                node.extras = tinygltf::Value(
                    tinygltf::Value::Object{{"jointLimits", tinygltf::Value(std::move(limits))}});
            }
        }
        const auto skinned = skinned_.find(index);
        LIMN_TRY(
            add_parts(node, scene_.nodes[skinned == skinned_.end() ? index : skinned->second]));
        if (source.parent < 0) {
            roots_.push_back(number_[index]);
        }
        model_.nodes.push_back(std::move(node));
        return Done{};
    }

    Status add_parts(tinygltf::Node& node, const GltfNode& source) {
        if (source.parts.empty()) {
            return Done{};
        }
        node.mesh = LIMN_TRY(add_mesh(source));
        node.skin = source.skin;
        if (source.first_morph >= 0) {
            const auto first = scene_.morph_weights.begin() + source.first_morph;
            const std::size_t count = scene_.meshes[source.parts[0].mesh].morphs.size();
            node.weights.assign(first, first + static_cast<std::ptrdiff_t>(count));
        }
        return Done{};
    }

    /// The node in the file of the first node of joint `joint`.
    Result<int> find_joint(std::size_t joint, const char* kind, const std::string& name) const {
        const auto found = std::ranges::find(scene_.joints, static_cast<std::int32_t>(joint));
        if (found == scene_.joints.end()) {
            return fail(
                "{}: found joint {} in the {} {}, expected one with a node", scene_.name, joint,
                kind, in_quotes(name));
        }
        return number_[static_cast<std::size_t>(found - scene_.joints.begin())];
    }

    Status add_clip(const ClipData& source) {
        tinygltf::Animation clip;
        clip.name = source.name;
        for (const ClipSheet& sheet : source.sheets) {
            if (!sheet.morphing.empty() || sheet.times.empty()) {
                return fail(
                    "{}: found {} in the clip {}, expected keys of joints only", scene_.name,
                    sheet.times.empty() ? "a sheet without keys" : "morph weights",
                    in_quotes(source.name));
            }
            const std::size_t first = clip.samplers.size();
            const int times = append_times(model_, sheet.times);
            LIMN_TRY(
                add_channels(clip, source.name, "rotation", sheet.rotating, times, [&](auto j) {
                    return store(quaternions_of(sheet.rotations, sheet.rotating.size(), j));
                }));
            LIMN_TRY(add_channels(
                clip, source.name, "translation", sheet.translating, times, [&](auto j) {
                    return store(column_of(sheet.translations, sheet.translating.size(), j));
                }));
            LIMN_TRY(add_channels(clip, source.name, "scale", sheet.scaling, times, [&](auto j) {
                return store(column_of(sheet.scales, sheet.scaling.size(), j));
            }));
            for (std::size_t i = first; i < clip.samplers.size(); ++i) {
                clip.samplers[i].interpolation = sheet.interpolation == Interpolation::Step ? "STEP"
                                                 : sheet.interpolation == Interpolation::Cubic
                                                     ? "CUBICSPLINE"
                                                     : "LINEAR";
            }
        }
        add_marks(source, clip);
        if (!clip.channels.empty()) {  // without, all animations become null
            model_.animations.push_back(std::move(clip));
        }
        return Done{};
    }

    /// A channel per joint; store_values(j) is the accessor of the j-th.
    template <typename StoreValues>
    Status add_channels(
        tinygltf::Animation& clip, const std::string& name, const char* path,
        const std::vector<std::uint16_t>& joints, int times, StoreValues&& store_values) {
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const int node = LIMN_TRY(find_joint(joints[j], "clip", name));
            append_channel(clip, node, path, times, store_values(j));
        }
        return Done{};
    }

    /// Contacts and events, see read_clip_marks.
    void add_marks(const ClipData& source, tinygltf::Animation& clip) const {
        const auto number = [](float value) { return tinygltf::Value(static_cast<double>(value)); };
        tinygltf::Value::Object limn;
        tinygltf::Value::Array contacts;
        for (const ClipContact& contact : source.contacts) {
            contacts.emplace_back(tinygltf::Value::Object{
                {"joint", tinygltf::Value(scene_.skeleton.joints[contact.joint])},
                {"begin", number(contact.begin)},
                {"end", number(contact.end)}});
        }
        tinygltf::Value::Array events;
        for (const ClipEvent& event : source.events) {
            events.emplace_back(tinygltf::Value::Object{
                {"name", tinygltf::Value(event.name)}, {"time", number(event.time)}});
        }
        if (!contacts.empty()) {
            limn.emplace("contacts", std::move(contacts));
        }
        if (!events.empty()) {
            limn.emplace("events", std::move(events));
        }
        if (!limn.empty()) {
            clip.extras = tinygltf::Value(
                tinygltf::Value::Object{{"limn", tinygltf::Value(std::move(limn))}});
        }
    }

    Status add_skin(const SkinData& source) {
        tinygltf::Skin skin;
        skin.name = source.name;
        std::vector<Mat4> matrices;
        for (std::size_t i = 0; i < source.joints.size(); ++i) {
            skin.joints.push_back(LIMN_TRY(find_joint(source.joints[i], "skin", source.name)));
            matrices.push_back(to_mat4(source.joint_from_mesh[i]));
        }
        skin.inverseBindMatrices = store(matrices);
        model_.skins.push_back(std::move(skin));
        return Done{};
    }

    Status add_material(const Material& source) {
        if (source.shading != ShadingModel::Pbr && source.shading != ShadingModel::Unlit
            && !is_extra_model(source.shading)) {
            return fail(
                "{}: found another shading model on the material {}, expected pbr or unlit, "
                "subsurface or hair",
                scene_.name, in_quotes(source.name));
        }
        tinygltf::Material material;
        material.name = source.name;
        material.pbrMetallicRoughness.baseColorFactor = numbers_of(source.base_color);
        material.pbrMetallicRoughness.metallicFactor = source.metalness;
        material.pbrMetallicRoughness.roughnessFactor = source.roughness;
        const float strength =
            std::max({source.emission.x, source.emission.y, source.emission.z, 1.0f});
        material.emissiveFactor = numbers_of(source.emission / strength);
        if (strength > 1) {
            use(material, "KHR_materials_emissive_strength",
                {{"emissiveStrength", tinygltf::Value(static_cast<double>(strength))}});
        }
        if (source.shading == ShadingModel::Unlit) {
            use(material, "KHR_materials_unlit", {});
        } else {
            for (const auto& [name, values] : write_layers(source, texture_writer())) {
                material.extensions.emplace(name, values);
                extensions_.insert(name);
            }
        }
        material.doubleSided = source.double_sided;
        material.alphaMode = source.alpha_mode == AlphaMode::Mask    ? "MASK"
                             : source.alpha_mode == AlphaMode::Blend ? "BLEND"
                                                                     : "OPAQUE";
        if (source.alpha_mode == AlphaMode::Mask) {
            material.alphaCutoff = source.alpha_cutoff;
        }
        tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        write_texture(source.base_color_texture, pbr.baseColorTexture);
        write_texture(source.metal_rough_texture, pbr.metallicRoughnessTexture);
        write_texture(source.normal_texture, material.normalTexture);
        material.normalTexture.scale = source.normal_scale;
        write_texture(source.occlusion_texture, material.occlusionTexture);
        material.occlusionTexture.strength = source.occlusion_strength;
        write_texture(source.emission_texture, material.emissiveTexture);
        add_extras(source, material);
        model_.materials.push_back(std::move(material));
        return Done{};
    }

    void add_extras(const Material& source, tinygltf::Material& material) {
        tinygltf::Value::Object limn = write_material_extras(source, texture_writer());
        if (!limn.empty()) {
            material.extras = tinygltf::Value(
                tinygltf::Value::Object{{"limn", tinygltf::Value(std::move(limn))}});
        }
    }

    /// For textures that tinygltf does not know.
    TextureWriter texture_writer() {
        return [this](const TextureSlot& slot) {
            tinygltf::TextureInfo info;
            write_texture(slot, info);
            tinygltf::Value::Object written = {
                {"index", tinygltf::Value(info.index)},
                {"texCoord", tinygltf::Value(info.texCoord)}};
            if (!info.extensions.empty()) {
                tinygltf::Value::Object extensions(info.extensions.begin(), info.extensions.end());
                written.emplace("extensions", tinygltf::Value(std::move(extensions)));
            }
            return written;
        };
    }

    template <typename Info>
    void write_texture(const TextureSlot& slot, Info& info) {
        write_texture_slot(model_, slot, info, extensions_);
    }

    void use(tinygltf::Material& material, const char* name, tinygltf::Value::Object values) {
        material.extensions.emplace(name, std::move(values));
        extensions_.insert(name);
    }

    const GltfScene& scene_;
    tinygltf::Model model_;
    std::vector<int> roots_;
    std::set<std::string> extensions_;            ///< in use
    std::vector<int> number_;                     ///< in the file, of each node
    std::map<std::size_t, std::size_t> skinned_;  ///< node with the skinned mesh, by its node
    std::set<std::size_t> merged_;                ///< nodes that are written as another's mesh
};

}  // namespace

Result<std::vector<std::byte>> write_glb(const GltfScene& scene) {
    return GlbWriter(scene).write();
}

Status save_glb(const std::string& path, const GltfScene& scene) {
    const std::vector<std::byte> bytes = LIMN_TRY(write_glb(scene));
    return write_file(path, bytes);
}

}  // namespace limn
