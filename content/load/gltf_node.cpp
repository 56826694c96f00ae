#include "content/load/gltf_document.h"
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

constexpr std::string_view kLightExtension = "KHR_lights_punctual";
constexpr std::uint32_t kNone = 0xffffffffu;

constexpr std::size_t kMaxMorphs = std::numeric_limits<std::uint16_t>::max();

/// Replaces a scale of 0, which has no inverse; some files hide nodes with it.
constexpr float kSmallestScale = 1e-6f;

constexpr float kSmallestFov = 0.01f;  // [rad]
constexpr float kLargestFov = 3.1f;    // [rad]

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
        : document_(document), nodes_(document.json["nodes"].items), parts_(parts), scene_(scene) {}

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
    [[nodiscard]] std::string place(std::size_t node) const {
        return fmt::format("{}: nodes[{}]", document_.file, node);
    }

    Status find_parents() {
        parent_.assign(nodes_.size(), kNone);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            for (const JsonValue& item : nodes_[i]["children"].items) {
                const std::int32_t child = index_of(item);
                std::uint32_t& parent = parent_[static_cast<std::size_t>(child)];
                if (parent != kNone) {
                    return fail(
                        "{}.children: found node {}, which is a child of nodes[{}] already, "
                        "expected one parent",
                        place(i), child, parent);
                }
                parent = i;
            }
        }
        return Done{};
    }

    /// Lists the nodes of the scene, parents first. Nodes unreachable from any root form cycles.
    Status order_nodes() {
        const std::vector<JsonValue>& scenes = document_.json["scenes"].items;
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
                place(static_cast<std::size_t>(cycle - reached.begin())));
        }
        if (scenes.empty()) {
            order_ = std::move(all);
            return Done{};
        }
        const std::int32_t scene = std::max(index_of(document_.json["scene"]), 0);
        reached.assign(nodes_.size(), false);
        for (const JsonValue& root : scenes[static_cast<std::size_t>(scene)]["nodes"].items) {
            const auto index = static_cast<std::uint32_t>(index_of(root));
            if (parent_[index] != kNone || reached[index]) {
                return fail(
                    "{}: scenes[{}].nodes: found node {}, which {}, expected each root once",
                    document_.file, scene, index,
                    reached[index] ? "is there twice" : "has a parent");
            }
            LIMN_TRY(visit(index, reached, order_));
        }
        return Done{};
    }

    /// Appends `root` and its descendants to `order`, without recursion. Each node has at most one
    /// parent, so nothing is visited twice.
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
                    "{}: found a hierarchy deeper than {} nodes", place(now.node),
                    document_.limits.max_depth);
            }
            reached[now.node] = true;
            order.push_back(now.node);
            const std::vector<JsonValue>& children = nodes_[now.node]["children"].items;
            for (auto child = children.rbegin(); child != children.rend(); ++child) {
                open.push_back({static_cast<std::uint32_t>(index_of(*child)), now.depth + 1});
            }
        }
        return Done{};
    }

    Status add_node(std::uint32_t index) {
        const JsonValue& source = nodes_[index];
        GltfNode node;
        node.name = source["name"].text;
        if (parent_[index] != kNone) {
            node.parent = static_cast<std::int32_t>(number_.at(parent_[index]));
        }
        LIMN_TRY(read_transform(index, node.transform));
        if (source.find("mesh") != nullptr && source.find("skin") == nullptr) {
            LIMN_TRY(add_parts(index, node));
        }
        read_camera(source, node);
        const std::int32_t light = index_of(source["extensions"][kLightExtension]["light"]);
        if (light >= 0) {
            node.light = make_light(light);
        }
        number_[index] = static_cast<std::uint32_t>(scene_.nodes.size());
        scene_.nodes.push_back(std::move(node));
        return Done{};
    }

    Status read_transform(std::uint32_t index, Transform& transform) {
        const JsonValue& source = nodes_[index];
        if (const std::vector<JsonValue>& items = source["matrix"].items; !items.empty()) {
            const auto m = [&](std::size_t i) { return items[i].number; };
            if (m(3) != 0 || m(7) != 0 || m(11) != 0 || m(15) != 1) {
                return fail(
                    "{}.matrix: found {}, {}, {}, {} as its last row, expected 0, 0, 0, 1",
                    place(index), m(3), m(7), m(11), m(15));
            }
            Mat4 matrix;
            for (int i = 0; i < 16; ++i) {
                matrix[i / 4][i % 4] = static_cast<float>(m(static_cast<std::size_t>(i)));
            }
            bool sheared = false;
            transform = decompose(matrix, sheared);
            if (sheared) {
                document_.warnings.push_back(place(index) + ".matrix: its shear is ignored");
            }
        } else {
            transform.position = vector_of(source["translation"], Vec3(0));
            transform.scale = vector_of(source["scale"], Vec3(1));
            LIMN_TRY(read_rotation(index, transform.rotation));
        }
        avoid_zero_scale(transform);
        return Done{};
    }

    Status read_rotation(std::uint32_t index, Quat& rotation) {
        const std::vector<JsonValue>& items = nodes_[index]["rotation"].items;
        if (items.empty()) {
            return Done{};
        }
        const glm::dvec4 q(items[0].number, items[1].number, items[2].number, items[3].number);
        const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        if (length < 1e-6) {
            return fail(
                "{}.rotation: found a quaternion of length {}, expected 1", place(index), length);
        }
        rotation = Quat(
            static_cast<float>(q.w / length), static_cast<float>(q.x / length),
            static_cast<float>(q.y / length), static_cast<float>(q.z / length));
        return Done{};
    }

    void read_camera(const JsonValue& source, GltfNode& node) {
        const std::int32_t index = index_of(source["camera"]);
        if (index < 0) {
            return;
        }
        const JsonValue& camera = json_item(document_, "cameras", index);
        if (camera["type"].text != "perspective") {
            document_.warnings.push_back(fmt::format(
                "{}: cameras[{}] is ignored: it is orthographic", document_.file, index));
            return;
        }
        // Wider or narrower than a level may have it: nothing else would be seen.
        const float fov_y = number_of(camera["perspective"]["yfov"], 0);
        node.has_camera = true;
        node.camera.fov_y = std::clamp(fov_y, kSmallestFov, kLargestFov);
        if (node.camera.fov_y != fov_y) {
            document_.warnings.push_back(fmt::format(
                "{}: cameras[{}].perspective.yfov: found {}, shown as {}", document_.file, index,
                fov_y, node.camera.fov_y));
        }
        node.camera.near = number_of(camera["perspective"]["znear"], 0);
        if (node.name.empty()) {
            node.name = camera["name"].text;
        }
    }

    /// No light, and a warning, if its type is unknown.
    [[nodiscard]] GltfLight make_light(std::int32_t index) {
        const JsonValue& lights = document_.json["extensions"][kLightExtension]["lights"];
        const JsonValue& source = lights.items[static_cast<std::size_t>(index)];
        const Vec3 color = vector_of(source["color"], Vec3(1));
        const float intensity = number_of(source["intensity"], 1);
        const float radius = number_of(source["range"], 0);  // 0 = none, as in our lights
        if (source["type"].text == "directional") {
            DirectionalLight light;
            light.color = color;
            light.illuminance = intensity;
            return light;
        }
        if (source["type"].text == "point") {
            PointLight light;
            light.color = color;
            light.intensity = intensity;
            light.radius = radius;
            return light;
        }
        if (source["type"].text != "spot") {
            document_.warnings.push_back(fmt::format(
                "{}: extensions.{}.lights[{}] is ignored: its type is {}, expected directional, "
                "point or spot",
                document_.file, kLightExtension, index, in_quotes(source["type"].text)));
            return {};
        }
        const JsonValue& spot = source["spot"];
        SpotLight light;
        light.color = color;
        light.intensity = intensity;
        light.radius = radius;
        light.outer_angle = std::min(number_of(spot["outerConeAngle"], 0.7853981634), 0.5f * kPi);
        light.inner_angle = std::min(number_of(spot["innerConeAngle"], 0), light.outer_angle);
        return light;
    }

    /// Their joints place them, not their nodes, so they get nodes of their own.
    Status add_skinned_meshes() {
        for (const std::uint32_t index : order_) {
            const JsonValue& source = nodes_[index];
            const std::string& name = source["name"].text;
            if (source.find("mesh") == nullptr || source.find("skin") == nullptr) {
                continue;
            }
            GltfNode node;
            node.name = name.empty() ? "" : name + ".skin";
            node.skin = index_of(source["skin"]);
            LIMN_TRY(add_parts(index, node));
            scene_.nodes.push_back(std::move(node));
        }
        return Done{};
    }

    /// Adds the parts of the mesh of node `index`, and weights for its morph targets.
    Status add_parts(std::uint32_t index, GltfNode& node) {
        const JsonValue& source = nodes_[index];
        const auto mesh = static_cast<std::size_t>(index_of(source["mesh"]));
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
                "{}: found more than {} morph targets in all nodes", place(index), kMaxMorphs);
        }
        const bool own = !source["weights"].items.empty();
        const std::vector<JsonValue>& values =
            (own ? source : document_.json["meshes"].items[mesh])["weights"].items;
        if (!values.empty() && values.size() != count) {
            return fail(
                "{}.weights: found {}, expected one for each of {} targets",
                own ? place(index) : fmt::format("{}: meshes[{}]", document_.file, mesh),
                values.size(), count);
        }
        node.first_morph = static_cast<std::int32_t>(weights.size());
        document_.node_morphs[index] = {node.first_morph, count};
        for (std::size_t i = 0; i < count; ++i) {
            weights.push_back(values.empty() ? 0.0f : static_cast<float>(values[i].number));
        }
        return Done{};
    }

    GltfDocument& document_;
    const std::vector<JsonValue>& nodes_;
    const GltfParts& parts_;
    GltfScene& scene_;
    std::vector<std::uint32_t> parent_;  ///< of each node of the file
    std::vector<std::uint32_t> order_;   ///< nodes of the scene, parents first
    std::unordered_map<std::uint32_t, std::uint32_t> number_;  ///< node of the file -> of the scene
};

}  // namespace

Status build_nodes(GltfDocument& document, const GltfParts& parts, GltfScene& scene) {
    return NodeBuilder(document, parts, scene).build();
}

}  // namespace limn
