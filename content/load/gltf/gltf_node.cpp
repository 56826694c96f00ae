#include "content/load/gltf/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace limn {

namespace {

constexpr const char* kLightExtension = "KHR_lights_punctual";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr std::size_t kMaxInstances = 100'000;  ///< of all nodes of a file
constexpr std::uint32_t kNone = 0xffffffffu;

constexpr std::size_t kMaxMorphs = std::numeric_limits<std::uint16_t>::max();

/// Replaces a scale of 0, which has no inverse; some files hide nodes with it.
constexpr float kSmallestScale = 1e-6f;

constexpr double kMatrixRounding = 1e-5;  ///< by which the last row of a matrix may be off

constexpr float kSmallestFov = 0.01f;  // [rad]
constexpr float kLargestFov = 3.1f;    // [rad]
constexpr float kSmallestMag = 1e-4f;  // half the height of an orthographic image [m]
constexpr float kLargestMag = 5e5f;    // [m]

/// Position, rotation and scale of an affine matrix; `sheared` is set if it has shear.
Transform decompose(const Mat4& matrix, bool& sheared) {
    Transform result;
    result.position = Vec3(matrix[3]);
    Mat3 axes(matrix);
    for (int i = 0; i < 3; ++i) {
        result.scale[i] = glm::length(axes[i]);
        axes[i] = normalize_or(axes[i], Vec3(i == 0, i == 1, i == 2));
    }
    sheared = std::abs(glm::dot(axes[0], axes[1])) > 1e-3f
              || std::abs(glm::dot(axes[1], axes[2])) > 1e-3f
              || std::abs(glm::dot(axes[2], axes[0])) > 1e-3f;
    if (glm::determinant(axes) < 0) {  // mirrored: an odd number of scales is negative
        result.scale.x = -result.scale.x;
        axes[0] = -axes[0];
    }
    // Gram-Schmidt, so that a sheared matrix gives a rotation as well.
    axes[1] =
        normalize_or(axes[1] - axes[0] * glm::dot(axes[0], axes[1]), any_perpendicular(axes[0]));
    axes[2] = glm::cross(axes[0], axes[1]);
    result.rotation = glm::normalize(glm::quat_cast(axes));
    return result;
}

void avoid_zero_scale(Transform& transform) {
    for (int i = 0; i < 3; ++i) {
        if (std::abs(transform.scale[i]) < kSmallestScale) {
            transform.scale[i] = std::copysign(kSmallestScale, transform.scale[i]);
        }
    }
}

class NodeBuilder {
  public:
    NodeBuilder(GltfDocument& document, const GltfParts& parts, GltfScene& scene)
        : document_(document), nodes_(document.model.nodes), parts_(parts), scene_(scene) {}

    Status build() {
        LIMN_TRY(find_parents());
        LIMN_TRY(order_nodes());
        document_.node_morphs.assign(nodes_.size(), {});
        for (const std::uint32_t index : order_) {
            LIMN_TRY(add_node(index));
        }
        LIMN_TRY(add_skinned_meshes());
        document_.scene_nodes.assign(nodes_.size(), -1);
        for (const auto& [node, number] : number_) {
            document_.scene_nodes[node] = static_cast<std::int32_t>(number);
        }
        return Done{};
    }

  private:
    [[nodiscard]] std::string where(std::size_t node) const {
        return fmt::format("{}: nodes[{}]", document_.file, node);
    }

    Status find_parents() {
        parent_.assign(nodes_.size(), kNone);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            for (const int child : nodes_[i].children) {
                std::uint32_t& parent = parent_[static_cast<std::size_t>(child)];
                if (parent == i) {
                    document_.warnings.push_back(fmt::format(
                        "{}.children: found node {} twice, expected it once", where(i), child));
                } else if (parent != kNone) {
                    return fail(
                        "{}.children: found node {}, which is a child of nodes[{}] already, "
                        "expected one parent",
                        where(i), child, parent);
                }
                parent = i;
            }
        }
        return Done{};
    }

    /// Lists the nodes of the scene, parents first. Nodes unreachable from any root form cycles.
    Status order_nodes() {
        const std::vector<tinygltf::Scene>& scenes = document_.model.scenes;
        std::vector<bool> reached(nodes_.size(), false);
        std::vector<std::uint32_t> all;
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (parent_[i] == kNone) {
                LIMN_TRY(visit(i, reached, all));
            }
        }
        if (all.size() < nodes_.size()) {
            const auto cycle = std::find(reached.begin(), reached.end(), false);
            return fail(
                "{}.children: found a node that is its own ancestor, expected a tree",
                where(static_cast<std::size_t>(cycle - reached.begin())));
        }
        if (scenes.empty()) {
            order_ = std::move(all);
            return Done{};
        }
        const int scene = std::max(document_.model.defaultScene, 0);
        LIMN_TRY(check_part("scenes", static_cast<std::size_t>(scene)));
        std::vector<bool> is_root(nodes_.size(), false);
        for (const int root : item_at(scenes, scene).nodes) {
            is_root[static_cast<std::size_t>(root)] = true;
        }
        reached.assign(nodes_.size(), false);
        for (const int root : item_at(scenes, scene).nodes) {
            const auto index = static_cast<std::uint32_t>(root);
            if (parent_[index] != kNone || reached[index]) {
                document_.warnings.push_back(fmt::format(
                    "{}: scenes[{}].nodes: found node {}, which {}, expected each root once",
                    document_.file, scene, index,
                    reached[index] ? "is listed already" : "has a parent"));
            }
            if (!reached[index] && !is_below_root(index, is_root)) {
                LIMN_TRY(visit(index, reached, order_));
            }
        }
        return Done{};
    }

    /// Whether an ancestor of a node is a root of the scene.
    [[nodiscard]] bool is_below_root(std::uint32_t node, const std::vector<bool>& is_root) const {
        while (parent_[node] != kNone) {
            node = parent_[node];
            if (is_root[node]) {
                return true;
            }
        }
        return false;
    }

    /// Fails if a bad part of the file is needed here.
    [[nodiscard]] Status check_part(std::string_view array, std::size_t index) const {
        const std::string* const reason = find_bad_part(document_, array, index);
        return reason != nullptr ? fail("{}: {}", document_.file, *reason) : Status(Done{});
    }

    /// Appends `root` and its descendants to `order`, without recursion; each node once.
    Status
    visit(std::uint32_t root, std::vector<bool>& reached, std::vector<std::uint32_t>& order) {
        struct Open {
            std::uint32_t node;
            std::uint32_t depth;
        };
        std::vector<Open> open = {{root, 1}};
        while (!open.empty()) {
            const Open now = open.back();
            open.pop_back();
            if (now.depth > document_.limits.max_depth) {
                return fail(
                    "{}: found a hierarchy deeper than {} nodes", where(now.node),
                    document_.limits.max_depth);
            }
            if (reached[now.node]) {
                continue;
            }
            reached[now.node] = true;
            order.push_back(now.node);
            const std::vector<int>& children = nodes_[now.node].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                open.push_back({static_cast<std::uint32_t>(*child), now.depth + 1});
            }
        }
        return Done{};
    }

    Status add_node(std::uint32_t index) {
        LIMN_TRY(check_part("nodes", index));
        const tinygltf::Node& source = nodes_[index];
        GltfNode node;
        node.name = source.name;
        // The root of a scene may have a parent that is not in the scene.
        if (const auto parent = number_.find(parent_[index]); parent != number_.end()) {
            node.parent = static_cast<std::int32_t>(parent->second);
        }
        LIMN_TRY(read_transform(index, node.transform));
        std::vector<Transform> instances;
        if (source.mesh >= 0 && source.skin < 0) {
            LIMN_TRY(add_parts(index, node));
            instances = LIMN_TRY(read_instances(index));
        }
        read_camera(source, node);
        const tinygltf::Value& light =
            member_of(extension_of(source.extensions, kLightExtension), "light");
        if (light.IsNumber()) {
            node.light = make_light(light.GetNumberAsInt());
        }
        number_[index] = static_cast<std::uint32_t>(scene_.nodes.size());
        scene_.nodes.push_back(std::move(node));
        add_instances(instances);
        return Done{};
    }

    /// The instances of the mesh of node `index`; none if it is drawn once.
    Result<std::vector<Transform>> read_instances(std::uint32_t index) {
        const tinygltf::Value& attributes =
            member_of(extension_of(nodes_[index].extensions, kInstancing), "attributes");
        std::vector<Transform> instances;
        for (const auto& [name, width] :
             {std::pair<const char*, int>{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}}) {
            if (!attributes.Has(name)) {
                continue;
            }
            const std::string here =
                fmt::format("{}.extensions.{}.attributes.{}", where(index), kInstancing, name);
            const std::vector<float> values = LIMN_TRY(
                read_floats(document_, attributes.Get(name).GetNumberAsInt(), width, here));
            const std::size_t count = values.size() / static_cast<std::size_t>(width);
            if (!instances.empty() && count != instances.size()) {
                return fail(
                    "{}: found {} elements, expected {} as in the attribute before it", here, count,
                    instances.size());
            }
            instances.resize(count);
            for (std::size_t i = 0; i < count; ++i) {
                set_instance(
                    instances[i], width, name, &values[i * static_cast<std::size_t>(width)]);
            }
        }
        if (instances.size() > kMaxInstances - instance_count_) {
            document_.warnings.push_back(fmt::format(
                "{}.extensions.{}: {} of its {} instances are drawn", where(index), kInstancing,
                kMaxInstances - instance_count_, instances.size()));
            instances.resize(kMaxInstances - instance_count_);
        }
        instance_count_ += instances.size();
        return instances;
    }

    static void
    set_instance(Transform& instance, int width, std::string_view name, const float* values) {
        if (width == 4) {
            const Quat rotation(values[3], values[0], values[1], values[2]);
            const float length = glm::length(rotation);
            instance.rotation = length > 1e-6f ? rotation / length : Quat(1, 0, 0, 0);
            return;
        }
        const Vec3 vector(values[0], values[1], values[2]);
        (name == "SCALE" ? instance.scale : instance.position) = vector;
        avoid_zero_scale(instance);
    }

    /// Moves the parts of the last node to a child for each instance.
    void add_instances(const std::vector<Transform>& instances) {
        const std::size_t parent = scene_.nodes.size() - 1;
        for (const Transform& instance : instances) {
            GltfNode node;
            node.parent = static_cast<std::int32_t>(parent);
            node.transform = instance;
            node.parts = scene_.nodes[parent].parts;
            node.first_morph = scene_.nodes[parent].first_morph;
            scene_.nodes.push_back(std::move(node));
        }
        if (!instances.empty()) {
            scene_.nodes[parent].parts.clear();
            scene_.nodes[parent].first_morph = -1;
        }
    }

    Status read_transform(std::uint32_t index, Transform& transform) {
        const tinygltf::Node& source = nodes_[index];
        if (const std::vector<double>& m = source.matrix; !m.empty()) {
            const double rest[] = {m[3], m[7], m[11], m[15] - 1};
            if (std::ranges::any_of(rest, [](double x) { return std::abs(x) > kMatrixRounding; })) {
                return fail(
                    "{}.matrix: found {}, {}, {}, {} as its last row, expected 0, 0, 0, 1",
                    where(index), m[3], m[7], m[11], m[15]);
            }
            Mat4 matrix;
            for (int i = 0; i < 16; ++i) {
                matrix[i / 4][i % 4] = static_cast<float>(m[static_cast<std::size_t>(i)]);
            }
            bool sheared = false;
            transform = decompose(matrix, sheared);
            if (sheared) {
                document_.warnings.push_back(where(index) + ".matrix: its shear is ignored");
            }
        } else {
            transform.position = vector_of(source.translation, Vec3(0));
            transform.scale = vector_of(source.scale, Vec3(1));
            transform.rotation = read_rotation(index);
        }
        avoid_zero_scale(transform);
        return Done{};
    }

    [[nodiscard]] Quat read_rotation(std::uint32_t index) {
        constexpr Quat kIdentity(1, 0, 0, 0);
        const std::vector<double>& items = nodes_[index].rotation;
        if (items.empty()) {
            return kIdentity;
        }
        const glm::dvec4 q(items[0], items[1], items[2], items[3]);
        const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        if (length < 1e-6) {
            document_.warnings.push_back(fmt::format(
                "{}.rotation: found a quaternion of length {}, expected 1; it is left out",
                where(index), length));
            return kIdentity;
        }
        return {
            static_cast<float>(q.w / length), static_cast<float>(q.x / length),
            static_cast<float>(q.y / length), static_cast<float>(q.z / length)};
    }

    void read_camera(const tinygltf::Node& source, GltfNode& node) {
        if (source.camera < 0) {
            return;
        }
        const tinygltf::Camera& camera = item_at(document_.model.cameras, source.camera);
        const auto within = [&](const char* member, double found, float smallest, float largest) {
            const auto shown = std::clamp(static_cast<float>(found), smallest, largest);
            if (shown != static_cast<float>(found)) {
                document_.warnings.push_back(fmt::format(
                    "{}: cameras[{}].{}: found {}, shown as {}", document_.file, source.camera,
                    member, static_cast<float>(found), shown));
            }
            return shown;
        };
        node.has_camera = true;
        if (camera.type == "orthographic") {
            node.camera.ortho_height =
                2
                * within("orthographic.ymag", camera.orthographic.ymag, kSmallestMag, kLargestMag);
            node.camera.near = std::max(static_cast<float>(camera.orthographic.znear), 1e-4f);
        } else {
            // Clamped to the range that a level may use.
            node.camera.fov_y =
                within("perspective.yfov", camera.perspective.yfov, kSmallestFov, kLargestFov);
            node.camera.near = static_cast<float>(camera.perspective.znear);
        }
        if (node.name.empty()) {
            node.name = camera.name;
        }
    }

    /// No light, and a warning, if its type is unknown.
    [[nodiscard]] GltfLight make_light(std::int32_t index) {
        const tinygltf::Light& source = item_at(document_.model.lights, index);
        const Vec3 color = vector_of(source.color, Vec3(1));
        const auto intensity = static_cast<float>(source.intensity);
        const auto radius = static_cast<float>(source.range);  // 0 = none, as in our lights
        if (source.type == "directional") {
            DirectionalLight light;
            light.color = color;
            light.illuminance = intensity;
            return light;
        }
        if (source.type == "point") {
            PointLight light;
            light.color = color;
            light.intensity = intensity;
            light.radius = radius;
            return light;
        }
        if (source.type != "spot") {
            document_.warnings.push_back(fmt::format(
                "{}: extensions.{}.lights[{}] is ignored: its type is {}, expected directional, "
                "point or spot",
                document_.file, kLightExtension, index, in_quotes(source.type)));
            return {};
        }
        SpotLight light;
        light.color = color;
        light.intensity = intensity;
        light.radius = radius;
        light.outer_angle = std::min(static_cast<float>(source.spot.outerConeAngle), 0.5f * kPi);
        light.inner_angle =
            std::min(static_cast<float>(source.spot.innerConeAngle), light.outer_angle);
        return light;
    }

    /// Their joints place them, not their nodes, so they get nodes of their own.
    Status add_skinned_meshes() {
        for (const std::uint32_t index : order_) {
            const tinygltf::Node& source = nodes_[index];
            if (source.mesh < 0 || source.skin < 0) {
                continue;
            }
            GltfNode node;
            node.name = source.name.empty() ? "" : source.name + ".skin";
            node.skin = source.skin;
            LIMN_TRY(add_parts(index, node));
            document_.skinned_nodes.emplace_back(scene_.nodes.size(), number_.at(index));
            scene_.nodes.push_back(std::move(node));
        }
        return Done{};
    }

    /// Adds the parts of the mesh of node `index`, and weights for its morph targets.
    Status add_parts(std::uint32_t index, GltfNode& node) {
        const tinygltf::Node& source = nodes_[index];
        const auto mesh = static_cast<std::size_t>(source.mesh);
        LIMN_TRY(check_part("meshes", mesh));
        node.parts = parts_[mesh];
        const std::size_t count =
            node.parts.empty() ? 0 : scene_.meshes[node.parts[0].mesh].morphs.size();
        for (const GltfPart& part : node.parts) {
            if (const std::size_t own = scene_.meshes[part.mesh].morphs.size(); own != count) {
                return fail(
                    "{}: meshes[{}].primitives: found {} and {} targets, expected as many in each",
                    document_.file, mesh, count, own);
            }
        }
        if (count == 0) {
            return Done{};
        }
        std::vector<float>& weights = scene_.morph_weights;
        if (weights.size() + count > kMaxMorphs) {
            return fail(
                "{}: found more than {} morph targets in all nodes", where(index), kMaxMorphs);
        }
        const bool own = !source.weights.empty();
        const std::vector<double>& values =
            own ? source.weights : document_.model.meshes[mesh].weights;
        if (!values.empty() && values.size() != count) {
            document_.warnings.push_back(fmt::format(
                "{}.weights: found {}, expected one for each of {} targets; missing ones are 0",
                own ? where(index) : fmt::format("{}: meshes[{}]", document_.file, mesh),
                values.size(), count));
        }
        node.first_morph = static_cast<std::int32_t>(weights.size());
        document_.node_morphs[index] = {node.first_morph, count};
        for (std::size_t i = 0; i < count; ++i) {
            weights.push_back(i < values.size() ? static_cast<float>(values[i]) : 0.0f);
        }
        return Done{};
    }

    GltfDocument& document_;
    const std::vector<tinygltf::Node>& nodes_;
    const GltfParts& parts_;
    GltfScene& scene_;
    std::size_t instance_count_ = 0;     ///< so far, of all nodes
    std::vector<std::uint32_t> parent_;  ///< of each node of the file
    std::vector<std::uint32_t> order_;   ///< nodes of the scene, parents first
    std::unordered_map<std::uint32_t, std::uint32_t> number_;  ///< node of the file -> of the scene
};

}  // namespace

Status build_nodes(GltfDocument& document, const GltfParts& parts, GltfScene& scene) {
    return NodeBuilder(document, parts, scene).build();
}

}  // namespace limn
