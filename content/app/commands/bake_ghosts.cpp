#include "content/app/commands/bake_ghosts.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/game/game.h"
#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/bvh_export.h"
#include "content/load/motion/bvh_file.h"
#include "content/load/motion/curve_plot.h"
#include "content/load/motion/ghost_figure.h"
#include "content/load/motion/motion_take.h"
#include "content/load/motion/motion_text.h"
#include "ecs/base/text.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

// Techniques: char.ghost-view

namespace limn {

struct GhostRecipe {
    std::string clip;
    GhostOptions ghosts;
};
LIMN_FIELDS(GhostRecipe) {
    LIMN_FIELD(clip, "of a glTF file, by name; none: the first");
    visit("begin", self.ghosts.begin, FieldMeta{"time of the first ghost", "s", 0, 1e6});
    visit("end", self.ghosts.end, FieldMeta{"latest time; 0: the end of the clip", "s", 0, 1e6});
    visit("step", self.ghosts.step, FieldMeta{"time from ghost to ghost", "s", 1e-3, 1e6});
    visit("trails", self.ghosts.trails, FieldMeta{"joints whose way is drawn"});
    visit(
        "highlight", self.ghosts.highlight,
        FieldMeta{"joint whose bones are yellow in all ghosts"});
}

struct CurveRecipe {
    std::string clip;
    std::string joint;
};
LIMN_FIELDS(CurveRecipe) {
    LIMN_FIELD(clip, "of a glTF file, by name; none: the first");
    LIMN_FIELD(joint, "whose channels are plotted");
}

namespace {

bool is_bvh(const std::string& path) {
    return equals_ignoring_case(std::filesystem::path(path).extension().string(), ".bvh");
}

Result<SkeletonMotion> load_motion_of(const std::string& path, const std::string& clip) {
    register_game_components();
    const MotionTake take = LIMN_TRY(load_motion_take(path, clip));
    if (!take.has_clip()) {
        return fail("{}: found no motion, expected a clip", path);
    }
    return take.motion();
}

}  // namespace

Status bake_ghosts(const BakeOptions& options) {
    GhostRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    const SkeletonMotion motion = LIMN_TRY(load_motion_of(options.in, recipe.clip));
    const std::string name = std::filesystem::path(options.out).stem().string();
    const Result<GltfScene> scene = make_ghost_scene(name, motion, recipe.ghosts);
    if (!scene) {
        return fail("{}: {}", options.in, scene.error().message);
    }
    LIMN_TRY(save_glb(options.out, *scene));
    fmt::print(
        "{}: {} ghosts\n", options.out, ghost_times(motion.clip.duration, recipe.ghosts).size());
    return Done{};
}

Status bake_curves(const BakeOptions& options) {
    CurveRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    BvhFile bvh;
    if (is_bvh(options.in)) {  // the channels as they were recorded
        bvh = LIMN_TRY(load_bvh(options.in));
    } else {
        const SkeletonMotion motion = LIMN_TRY(load_motion_of(options.in, recipe.clip));
        const float rate = find_motion_rate(motion.clip);
        if (const Status count = check_pose_count(motion, rate); !count) {
            return fail("{}: {}", options.in, count.error().message);
        }
        bvh = make_bvh_file(motion, rate);
    }
    const Result<std::vector<ChannelCurve>> curves = find_channel_curves(bvh, recipe.joint);
    if (!curves) {
        return fail("{}: {}", options.in, curves.error().message);
    }
    LIMN_TRY(write_file(options.out, plot_curves(recipe.joint, *curves, bvh.frame_time)));
    fmt::print("{}: {} curves of {} samples\n", options.out, curves->size(), bvh.frames);
    return Done{};
}

}  // namespace limn
