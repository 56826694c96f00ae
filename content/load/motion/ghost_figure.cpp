#include "content/load/motion/ghost_figure.h"

#include "content/bake/tangents.h"
#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_strokes.h"
#include "content/load/motion/bone_figure.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

// Techniques: char.ghost-view

namespace limn {
namespace {

constexpr std::size_t kMaxGhosts = 1000;
constexpr float kFaintest = 0.15f;  ///< opacity of the first ghost; by eye

Result<std::uint16_t> find_joint_named(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    if (found == skeleton.joints.end()) {
        const std::vector<std::string_view> names(skeleton.joints.begin(), skeleton.joints.end());
        return fail("found no joint {}{}", in_quotes(name), did_you_mean(name, names));
    }
    return static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

/// The triangles of `mesh` that move with `joint` of the skin, or all others, in a pose.
MeshData pose_mesh(
    const MeshData& mesh, const SkinData& skin, const std::vector<Affine>& joints,
    std::optional<std::uint16_t> joint, bool keeps_joint) {
    MeshData posed;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i];
        const std::uint16_t bone = mesh.skin.joints[v];
        const bool is_joint = joint && skin.joints[bone] == *joint;
        if (is_joint != keeps_joint) {
            continue;
        }
        const Affine moved = joints[skin.joints[bone]] * skin.joint_from_mesh[bone];
        posed.indices.push_back(static_cast<std::uint32_t>(posed.positions.size()));
        posed.positions.push_back(transform_point(moved, mesh.positions[v]));
    }
    posed.uvs.assign(posed.positions.size(), Vec2(0));
    generate_normals(posed, 0.0f);
    generate_tangents(posed);
    update_bounds(posed);
    return posed;
}

class GhostScene {
  public:
    GhostScene(const std::string& name, const SkeletonMotion& motion)
        : below_(make_motion_scene(name, motion)), figure_(make_bone_figure(below_.skeleton)),
          clip_(below_.clips.empty() ? ClipData{} : below_.clips[0]) {
        scene_.name = name;
    }

    [[nodiscard]] const SkeletonData& skeleton() const { return below_.skeleton; }

    void add_ghost(float time, float opacity, std::optional<std::uint16_t> highlight) {
        const std::vector<Affine> joints = joints_at(time);
        for (std::size_t m = 0; m < figure_.meshes.size(); ++m) {
            Material material = figure_.materials[m];
            material.base_color.w = opacity;
            material.alpha_mode = opacity < 1 ? AlphaMode::Blend : AlphaMode::Opaque;
            for (const bool is_highlight : {false, true}) {
                MeshData mesh =
                    pose_mesh(figure_.meshes[m], figure_.skin, joints, highlight, is_highlight);
                add_part(
                    std::move(mesh),
                    is_highlight
                        ? Material{.name = "highlight", .base_color = {0.9f, 0.6f, 0.02f, 1}}
                        : material);
            }
        }
    }

    /// The way of a joint through all samples of the clip.
    void add_trail(std::uint16_t joint, float begin, float end) {
        std::vector<Vec3> path;
        const float rate = find_motion_rate(clip_);
        const auto first = static_cast<int>(std::ceil(begin * rate - 1e-3f));
        const auto last = static_cast<int>(std::floor(end * rate + 1e-3f));
        for (int f = first; f <= last; ++f) {
            path.push_back(
                transform_point(joints_at(static_cast<float>(f) / rate)[joint], Vec3(0)));
        }
        std::vector<std::uint32_t> order(path.size());
        std::iota(order.begin(), order.end(), 0u);
        const Strokes strokes = make_strokes(path, order, kGltfLineStrip);
        MeshData mesh;
        for (std::size_t i = 0; i < strokes.sources.size(); ++i) {
            mesh.positions.push_back(path[strokes.sources[i]] + strokes.offsets[i]);
        }
        mesh.normals = strokes.normals;
        mesh.uvs.assign(mesh.positions.size(), Vec2(0));
        mesh.indices = strokes.indices;
        if (!mesh.indices.empty()) {
            generate_tangents(mesh);
        }
        update_bounds(mesh);
        add_part(
            std::move(mesh), {.name = "trail of " + skeleton().joints[joint],
                              .base_color = {0.8f, 0.05f, 0.1f, 1},
                              .emission = {0.2f, 0.01f, 0.02f}});
    }

    GltfScene take() {
        scene_.joints.assign(scene_.nodes.size(), -1);
        return std::move(scene_);
    }

  private:
    [[nodiscard]] std::vector<Affine> joints_at(float time) const {
        const LocalPose pose = sample_motion(below_.skeleton, clip_, time);
        return find_frame_joints(
            below_.skeleton, {1, pose.size(), pose.translations, pose.rotations, pose.scales}, 0);
    }

    void add_part(MeshData mesh, Material material) {
        if (mesh.indices.empty()) {
            return;
        }
        const auto index = static_cast<std::uint32_t>(scene_.meshes.size());
        mesh.name = material.name;
        GltfNode& node = scene_.nodes.emplace_back();
        node.name = format_text("{} {}", material.name, index);
        node.parts.push_back({index, index});
        scene_.meshes.push_back(std::move(mesh));
        scene_.materials.push_back(std::move(material));
    }

    GltfScene below_;
    BoneFigure figure_;
    ClipData clip_;
    GltfScene scene_;
};

}  // namespace

std::vector<float> ghost_times(float duration, const GhostOptions& options) {
    LIMN_CHECK(options.step > 0);
    const float end = options.end > 0 ? std::min(options.end, duration) : duration;
    const float length = std::max(end - options.begin, 0.0f);
    const auto steps = static_cast<std::size_t>(length / options.step + 1e-3f);
    std::vector<float> times;
    for (std::size_t k = 0; k <= std::min(steps, kMaxGhosts); ++k) {
        times.push_back(options.begin + static_cast<float>(k) * options.step);
    }
    return times;
}

float ghost_opacity(std::size_t ghost, std::size_t count) {
    return glm::mix(kFaintest, 0.8f, static_cast<float>(ghost + 1) / static_cast<float>(count));
}

Result<GltfScene> make_ghost_scene(
    const std::string& name, const SkeletonMotion& motion, const GhostOptions& options) {
    GhostScene ghosts(name, motion);
    const std::vector<float> times = ghost_times(motion.clip.duration, options);
    if (times.size() > kMaxGhosts) {
        return fail(
            "found steps of {} s in {} s, expected at most {} ghosts", options.step,
            motion.clip.duration, kMaxGhosts);
    }
    std::optional<std::uint16_t> highlight;
    if (!options.highlight.empty()) {
        highlight = LIMN_TRY(find_joint_named(ghosts.skeleton(), options.highlight));
    }
    for (std::size_t k = 0; k < times.size(); ++k) {
        const bool is_last = k + 1 == times.size();
        ghosts.add_ghost(times[k], is_last ? 1.0f : ghost_opacity(k, times.size()), highlight);
    }
    for (const std::string& trail : options.trails) {
        const std::uint16_t joint = LIMN_TRY(find_joint_named(ghosts.skeleton(), trail));
        const float end = options.end > 0 ? options.end : motion.clip.duration;
        ghosts.add_trail(joint, options.begin, std::min(end, motion.clip.duration));
    }
    return ghosts.take();
}

}  // namespace limn
