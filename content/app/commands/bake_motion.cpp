#include "content/app/commands/bake_motion.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/body_retarget.h"
#include "content/bake/motion/contact_detection.h"
#include "content/bake/motion/flight_curve.h"
#include "content/bake/motion/loop_finding.h"
#include "content/bake/motion/marker_cleanup.h"
#include "content/bake/motion/marker_joints.h"
#include "content/bake/motion/motion_filter.h"
#include "content/game/game.h"
#include "content/load/faces/marker_file.h"
#include "content/load/motion/motion_take.h"
#include "content/load/motion/motion_text.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Techniques: char.marker-to-joint, char.mocap-cleanup, char.retarget-body

namespace limn {

/// Where a marker is on a body.
struct MarkerPlace {
    std::string marker;
    std::string joint;
    Vec3 at = Vec3(0);
};
LIMN_FIELDS(MarkerPlace) {
    LIMN_FIELD(marker, "its name in the .trc file");
    LIMN_FIELD(joint, "of the body, that it moves with");
    LIMN_FIELD(at, "where it is in the body's rest pose", "m");
}

struct MotionRecipe {
    std::string clip;
    float rate = 0.0f;
    float cutoff = 0.0f;
    bool travel = false;
    bool loop = false;
    float loop_min = 0.4f;
    float loop_max = 0.0f;
    bool contacts = true;
    float contact_speed = 0.25f;
    float contact_height = 0.06f;
    float swap_margin = 0.02f;
    float max_gap = 0.5f;
    std::vector<MarkerPlace> markers;
};
LIMN_FIELDS(MotionRecipe) {
    LIMN_FIELD(clip, "of a glTF file, by name; none: the first");
    LIMN_FIELD(rate, "keys per second; 0: as recorded", "1/s", 0, 1000);
    LIMN_FIELD(cutoff, "of the low-pass filter against noise; 0: none", "Hz", 0, 1000);
    LIMN_FIELD(travel, "moves a walk on the spot so that planted feet stay");
    LIMN_FIELD(loop, "cuts out the interval that repeats best, and closes its seam");
    LIMN_FIELD(loop_min, "shortest loop", "s", 0.05, 1000);
    LIMN_FIELD(loop_max, "longest loop; 0: any", "s", 0, 1000);
    LIMN_FIELD(contacts, "finds contacts of feet");
    LIMN_FIELD(contact_speed, "of a foot at the beginning of a contact", "leg lengths/s", 0, 10);
    LIMN_FIELD(contact_height, "above the lowest point nearby", "leg lengths", 0, 1);
    LIMN_FIELD(
        swap_margin, "markers exchange labels if that fits better by this; 0: never", "m", 0, 1);
    LIMN_FIELD(max_gap, "longest gap of a marker that is filled", "s", 0, 100);
    LIMN_FIELD(markers, "of a .trc file, on the body");
}

struct RetargetRecipe {
    std::string clip;
    bool pin_feet = true;
    float fade = 0.15f;
    float hands = 0.0f;
    bool travel = false;
};
LIMN_FIELDS(RetargetRecipe) {
    LIMN_FIELD(clip, "of a glTF file, by name; none: the first");
    LIMN_FIELD(pin_feet, "planted feet stay where they are");
    LIMN_FIELD(fade, "of the correction after a contact", "s", 0, 10);
    LIMN_FIELD(hands, "importance of the way of the hands over angles", "", 0, 1);
    LIMN_FIELD(travel, "moves a walk on the spot first, so that planted feet stay");
}

namespace {

ContactOptions contact_options(const MotionRecipe& recipe) {
    ContactOptions options;
    options.speed = recipe.contact_speed;
    options.height = recipe.contact_height;
    return options;
}

std::uint16_t joint_named(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    return found == skeleton.joints.end()
               ? BodyMarker::kUnused
               : static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

/// The body with the motion of the markers.
Result<MotionTake> take_of_markers(const BakeOptions& options, const MotionRecipe& recipe) {
    if (options.body.empty() || recipe.markers.empty()) {
        return fail(
            "{}: found {}, expected BODY, a skeleton, after the .trc file and its markers in "
            "--recipe",
            options.in, options.body.empty() ? "no body" : "no markers");
    }
    MotionTake take = LIMN_TRY(load_motion_take(options.body));
    MarkerMotion markers = LIMN_TRY(load_trc(options.in));
    std::vector<BodyMarker> places(markers.markers());
    std::map<std::uint16_t, MarkerSegment> by_joint;
    for (const MarkerPlace& place : recipe.markers) {
        const auto marker = std::find(markers.names.begin(), markers.names.end(), place.marker);
        const std::uint16_t joint = joint_named(take.scene.skeleton, place.joint);
        if (marker == markers.names.end() || joint == BodyMarker::kUnused) {
            const bool is_marker = marker == markers.names.end();
            const auto& names = is_marker ? markers.names : take.scene.skeleton.joints;
            const std::vector<std::string_view> known(names.begin(), names.end());
            const std::string& found = is_marker ? place.marker : place.joint;
            return fail(
                "{}: found the {} {}, expected one of {}{}", options.recipe,
                is_marker ? "marker" : "joint", in_quotes(found),
                is_marker ? options.in : options.body, did_you_mean(found, known));
        }
        const auto m = static_cast<std::size_t>(marker - markers.names.begin());
        places[m] = {joint, place.at};
        by_joint[joint].push_back(static_cast<std::uint32_t>(m));
    }
    std::vector<MarkerSegment> segments;
    for (auto& [joint, segment] : by_joint) {
        segments.push_back(std::move(segment));
    }
    const CleanupCounts counts =
        clean_markers(markers, segments, {recipe.swap_margin, recipe.max_gap, recipe.cutoff});
    const Result<MarkerFit> fit = fit_markers(take.scene.skeleton, places, markers);
    if (!fit) {
        return fail("{}: {}", options.in, fit.error().message);
    }
    fmt::print(
        "{}: {} labels exchanged, {} positions filled, {} missing, residual {:.1f} mm\n",
        options.in, counts.swaps, counts.filled, counts.unfilled, fit->residual * 1000);
    ClipData like;
    like.name = std::filesystem::path(options.in).stem().string();
    take.scene.clips = {make_frames_clip(take.scene.skeleton, fit->frames, like)};
    take.clip = 0;
    return take;
}

/// Fails where there are too many poses; warns of what is lost.
Status check_motion(const std::string& file, const SkeletonMotion& motion, float rate) {
    if (const Status count = check_pose_count(motion, rate); !count) {
        return fail("{}: {}", file, count.error().message);
    }
    for (const ClipSheet& sheet : motion.clip.sheets) {
        if (!sheet.morphing.empty()) {
            log_warn("{}: found morph weights in the clip, which are left out", file);
            break;
        }
    }
    return Done{};
}

/// Puts the contacts that follow from the frames into the clip, and counts flights between.
void mark_contacts(
    const SkeletonMotion& motion, const MotionFrames& frames, const MotionRecipe& recipe,
    ClipData& clip) {
    const std::vector<std::uint16_t> feet = find_foot_joints(find_body_joints(motion.skeleton));
    clip.contacts = detect_contacts(motion.skeleton, frames, feet, contact_options(recipe));
    for (const FlightCurve& flight : extract_flights(motion.skeleton, frames, clip.contacts)) {
        fmt::print(
            "    {} flies {:.2f} to {:.2f} s: {:.3f} m far, {:.3f} m high\n",
            motion.skeleton.joints[flight.joint], flight.begin, flight.end, flight.length,
            flight.height);
    }
}

}  // namespace

Status bake_motion(const BakeOptions& options) {
    register_game_components();
    MotionRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    const bool is_trc =
        equals_ignoring_case(std::filesystem::path(options.in).extension().string(), ".trc");
    MotionTake take = LIMN_TRY(
        is_trc ? take_of_markers(options, recipe) : load_motion_take(options.in, recipe.clip));
    if (!take.has_clip()) {
        return fail("{}: found no motion, expected a clip", options.in);
    }
    const SkeletonMotion motion = take.motion();
    const float rate = recipe.rate > 0 ? recipe.rate : find_motion_rate(motion.clip);
    LIMN_TRY(check_motion(options.in, motion, rate));
    MotionFrames frames = sample_frames(motion, rate);
    if (recipe.cutoff > 0 && !is_trc) {
        smooth_frames(frames, recipe.cutoff);
    }
    const float traveled = recipe.travel ? add_travel(motion.skeleton, frames) : 0.0f;
    if (recipe.loop) {
        const auto loop = find_loop(motion.skeleton, frames, recipe.loop_min, recipe.loop_max);
        if (!loop) {
            return fail(
                "{}: found {} s, expected more than the shortest loop, {} s", options.in,
                frames.duration(), recipe.loop_min);
        }
        fmt::print(
            "loop from {:.3f} to {:.3f} s, {:.1f} mm apart before it was closed\n",
            static_cast<float>(loop->first) / frames.rate,
            static_cast<float>(loop->last) / frames.rate, loop->error * 1000);
        frames = cut_loop(motion.skeleton, frames, *loop);
    }
    ClipData clip = make_frames_clip(motion.skeleton, frames, motion.clip);
    if (recipe.contacts) {
        mark_contacts(motion, frames, recipe, clip);
    }
    fmt::print(
        "{}: {} key{}, {:.2f} s, {} contacts{}\n", options.out, frames.frames(),
        frames.frames() == 1 ? " (a pose, no motion)" : "s", clip.duration, clip.contacts.size(),
        recipe.travel ? fmt::format(", travels {:.2f} m", traveled) : std::string());
    take.scene.clips[take.clip] = std::move(clip);
    return save_motion_take(options.out, take);
}

Status bake_retarget(const BakeOptions& options) {
    register_game_components();
    RetargetRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    if (options.body.empty()) {
        return fail("{}: found no body, expected BODY after the motion", options.in);
    }
    const MotionTake source = LIMN_TRY(load_motion_take(options.in, recipe.clip));
    if (!source.has_clip()) {
        return fail("{}: found no motion, expected a clip", options.in);
    }
    SkeletonMotion motion = source.motion();
    if (recipe.travel) {
        LIMN_TRY(check_motion(options.in, motion, find_motion_rate(motion.clip)));
        MotionFrames frames = sample_frames(motion, find_motion_rate(motion.clip));
        add_travel(motion.skeleton, frames);
        motion.clip = make_frames_clip(motion.skeleton, frames, motion.clip);
    }
    MotionTake body = LIMN_TRY(load_motion_take(options.body));
    RetargetReport report;
    const RetargetOptions settings = {
        .pin_feet = recipe.pin_feet, .fade = recipe.fade, .hands = recipe.hands, .contacts = {}};
    Result<ClipData> clip = retarget_motion(motion, body.scene.skeleton, settings, &report);
    if (!clip) {
        return fail("{}, {}: {}", options.in, options.body, clip.error().message);
    }
    fmt::print(
        "{}: {} of {} joints follow, legs {:.2f} times as long, {} contacts, feet slide {:.2f} mm "
        "({:.1f} mm without pins), hips lowered {:.1f} mm\n",
        options.out, report.joints, body.scene.skeleton.joints.size() - 1, report.scale,
        report.contacts, report.slide * 1000, report.slide_before * 1000, report.lowered * 1000);
    body.scene.clips = {*std::move(clip)};
    body.clip = 0;
    return save_motion_take(options.out, body);
}

}  // namespace limn
