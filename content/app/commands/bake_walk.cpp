#include "content/app/commands/bake_walk.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/model_scene.h"
#include "content/game/game.h"
#include "content/load/motion/motion_take.h"
#include "content/make/make_mesh.h"
#include "ecs/base/text.h"
#include "ecs/components/walk.h"
#include "ecs/reflect.h"
#include "systems/animation/walk/walk_body.h"
#include "systems/animation/walk/walk_clip.h"
#include "systems/animation/walk/walk_take.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: char.walk-control, char.walk-cycle

namespace limn {

/// A walk, and where it goes.
struct WalkRecipe {
    Walk walk = {};
    float limp = 0.0f;
    float pace = 0.0f;
    float turn = 0.0f;
    std::vector<RoutePoint> points;
    bool standing = false;
    bool cycle = false;
    float seconds = 0.0f;
    float rate = 60.0f;
};

/// Those of Walk, without the one that is about worlds; and the course.
LIMN_FIELDS(WalkRecipe) {
    visit_fields(self.walk, [&](const char* name, auto& field, const FieldMeta& meta) {
        if (std::string_view(name) != "moves_root") {
            visit(name, field, meta);
        }
    });
    LIMN_FIELD(limp, "weakness of the left leg; < 0: of the right one", "", -1, 1);
    LIMN_FIELD(
        pace, "goes at this speed, runs where people do; 0: the comfortable one", "m/s", 0, 100);
    LIMN_FIELD(turn, "turns to the left by this", "rad/s", -20, 20);
    LIMN_FIELD(points, "goes from one to the next instead, and stops at the last");
    LIMN_FIELD(standing, "begins at rest, as with points");
    LIMN_FIELD(cycle, "two steps at the comfortable speed that repeat, on the spot");
    LIMN_FIELD(seconds, "0: 4, with points until it stands", "s", 0, kMaxWalkTake);
    LIMN_FIELD(rate, "keys per second", "1/s", 5, 480);
}

namespace {

/// Of a leg that limps.
constexpr LegWeights kWeakest = {.hip = 0.3f, .knee = 0.2f, .ankle = 0.3f};

LegWeights weaken(const LegWeights& leg, float by) {
    const auto less = [&](float own, float weakest) { return own * (1 - by * (1 - weakest)); };
    return {
        less(leg.hip, kWeakest.hip), less(leg.knee, kWeakest.knee),
        less(leg.ankle, kWeakest.ankle)};
}

/// A file, or a model that `limn make` makes.
Result<MotionTake> load_walker(const BakeOptions& options) {
    const MeshKind* const kind = find_kind(mesh_kinds(), options.in);
    if (kind == nullptr || kind->make_rig == nullptr || std::filesystem::exists(options.in)) {
        return load_motion_take(options.in);
    }
    MotionTake take;
    const std::string name = std::filesystem::path(options.out).stem().string();
    take.scene = LIMN_TRY(make_model_scene({.kind = options.in, .name = name}));
    return take;
}

ClipData make_clip(const SkeletonData& skeleton, const WalkRecipe& recipe) {
    if (recipe.cycle) {
        const auto keys = [&](float duration) {
            return std::max<std::size_t>(
                static_cast<std::size_t>(std::round(duration * recipe.rate)) + 1, 2);
        };
        ClipData clip = make_walk_clip(
            skeleton, recipe.walk, keys(make_walk_clip(skeleton, recipe.walk, 2).duration));
        drop_still_joints(skeleton, clip.sheets.front());
        return clip;
    }
    const WalkCourse course = {recipe.pace, recipe.turn, recipe.points, recipe.standing};
    const float seconds = recipe.seconds > 0 || !recipe.points.empty() ? recipe.seconds : 4.0f;
    return make_walk_take(skeleton, recipe.walk, course, seconds, recipe.rate);
}

}  // namespace

Status bake_walk(const BakeOptions& options) {
    register_game_components();
    WalkRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    recipe.walk.left = weaken(recipe.walk.left, std::max(recipe.limp, 0.0f));
    recipe.walk.right = weaken(recipe.walk.right, std::max(-recipe.limp, 0.0f));
    MotionTake take = LIMN_TRY(load_walker(options));
    const SkeletonData& skeleton = take.scene.skeleton;
    if (!find_walk_body(skeleton).can_walk) {
        return fail(
            "{}: found a skeleton of {} joints without two legs, expected thighs, shins and feet "
            "by their names, such as LeftUpLeg, LeftLeg and LeftFoot",
            options.in, skeleton.joints.size() - 1);
    }
    ClipData clip = make_clip(skeleton, recipe);
    fmt::print(
        "{}: {} keys, {:.2f} s, {} steps, {} contacts\n", options.out,
        clip.sheets.front().times.size(), clip.duration, clip.events.size(), clip.contacts.size());
    take.scene.clips = {std::move(clip)};
    take.clip = 0;
    return save_motion_take(options.out, take);
}

}  // namespace limn
