#include "content/make/head/head_clips.h"

#include "content/make/head/head_expressions.h"
#include "content/make/head/head_visemes.h"
#include "content/speech/face_clip.h"
#include "content/speech/head_motion.h"
#include "content/speech/utterance.h"
#include "ecs/base/math.h"
#include "ecs/components/wrinkle_maps.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace limn {

namespace {

struct Face {
    std::string_view name;
    std::array<UnitWeight, 7> units;  ///< sided units without a suffix: both halves
    WrinkleWeights wrinkles = {};     ///< of wrinkle maps
};

constexpr Face kFaces[] = {
    {"smile",
     {{{"AU6", 0.8f}, {"AU12", 0.9f}, {"AU10", 0.35f}, {"AU25", 0.9f}}},
     {.preset = WrinklePreset::Smile}},
    {"surprise",
     {{{"AU1", 1}, {"AU2", 1}, {"AU5", 0.8f}, {"AU26", 1}, {"AU25", 0.3f}}},
     {.preset = WrinklePreset::Surprised}},
    {"frown",
     {{{"AU4", 1}, {"AU7", 0.7f}, {"AU23", 0.6f}, {"AU24", 0.4f}, {"AU17", 0.3f}}},
     {.preset = WrinklePreset::Frown, .chin = 0.3f}},
    {"sadness",
     {{{"AU1", 0.9f}, {"AU4", 0.5f}, {"AU15", 0.9f}, {"AU17", 0.5f}, {"AU41", 0.4f}}},
     {.left_brow = -0.5f, .right_brow = -0.5f, .middle_brow = 0.5f, .chin = 0.6f}},
    {"disgust",
     {{{"AU9", 1}, {"AU10", 0.5f}, {"AU15", 0.4f}, {"AU7", 0.5f}, {"AU25", 0.3f}}},
     {.preset = WrinklePreset::Sour}},
    {"fear",
     {{{"AU1", 0.9f},
       {"AU2", 0.6f},
       {"AU4", 0.6f},
       {"AU5", 0.9f},
       {"AU20", 0.8f},
       {"AU26", 0.4f},
       {"AU25", 0.5f}}},
     {.left_brow = -0.8f, .right_brow = -0.8f, .middle_brow = -0.4f, .lips = -0.5f}},
    {"pucker", {{{"AU18", 1}}}, {.preset = WrinklePreset::Pout}},
    {"puff", {{{"AU34", 1}, {"AU24", 0.3f}}}},
    {"wink",
     {{{"AU46_L", 1}, {"AU6_L", 0.4f}, {"AU12_L", 0.7f}, {"AU12_R", 0.35f}, {"AU2_R", 0.3f}}},
     {.left_cheek = 0.7f, .right_cheek = 0.3f, .upper_left_cheek = 1}},
    {"doubt",
     {{{"AU2_L", 1}, {"AU1_L", 0.4f}, {"AU4_R", 0.7f}, {"AU14_R", 0.6f}, {"AU17", 0.4f}}},
     {.left_brow = -1, .right_brow = 0.7f, .chin = 0.5f}},
    {"gape",
     {{{"AU27", 0.9f}, {"AU25", 0.3f}, {"AU2", 0.3f}}},
     {.lips = -1, .left_cheek = -0.6f, .right_cheek = -0.6f, .chin = -1}},
};

constexpr float kFaceTime = 2.4f;  ///< duration of one expression, from rest to rest [s]

struct Key {
    float time;
    float weight;  ///< of the expression
};
constexpr std::array<Key, 4> kRise = {{{0, 0}, {0.4f, 1}, {1.7f, 1}, {2.2f, 0}}};

/// Adds the weight curve of one target to `clip`.
void add_curve(
    ClipData& clip, std::uint16_t target, std::vector<float> times, std::vector<float> weights) {
    ClipSheet sheet;
    sheet.times = std::move(times);
    sheet.weights = std::move(weights);
    sheet.morphing = {target};
    clip.duration = std::max(clip.duration, sheet.times.back());
    clip.sheets.push_back(std::move(sheet));
}

/// Index of the first wrinkle channel.
std::uint16_t first_channel(const HeadShape& shape) {
    return static_cast<std::uint16_t>(expression_count() + (shape.grows_old ? 1 : 0));
}

/// Weights by morph target.
std::vector<std::pair<std::uint16_t, float>> targets_of(const Face& face, const HeadShape& shape) {
    std::vector<std::pair<std::uint16_t, float>> targets;
    for (const UnitWeight& part : face.units) {
        if (part.weight == 0) {
            continue;
        }
        const std::string name(part.unit);
        const bool both = std::ranges::any_of(action_units(), [&](const ActionUnit& unit) {
            return unit.name == part.unit && unit.sided;
        });
        if (both) {
            targets.emplace_back(expression_index(name + "_L"), part.weight);
            targets.emplace_back(expression_index(name + "_R"), part.weight);
        } else {
            targets.emplace_back(expression_index(name), part.weight);
        }
    }
    if (shape.wrinkle_channels) {
        std::uint16_t channel = first_channel(shape);
        for (const float weight : region_weights(face.wrinkles)) {
            targets.emplace_back(channel++, weight);
        }
    }
    return targets;
}

ClipData make_face_clip(const Face& face, const HeadShape& shape) {
    ClipData clip;
    clip.name = face.name;
    for (const auto& target : targets_of(face, shape)) {
        std::vector<float> times;
        std::vector<float> weights;
        for (const Key& key : kRise) {
            times.push_back(key.time);
            weights.push_back(key.weight * target.second);
        }
        add_curve(clip, target.first, std::move(times), std::move(weights));
    }
    return clip;
}

/// Adds a key of both eyes, converged at 0.8 m, turned sideways and up by angles [degrees].
void add_gaze(ClipSheet& sheet, float time, const Vec2& look) {
    constexpr float kConverge = 2.2f;
    sheet.times.push_back(time);
    for (const float side : {1.0f, -1.0f}) {
        sheet.rotations.push_back(
            glm::angleAxis(radians(look.x - kConverge * side), Vec3(0, 1, 0))
            * glm::angleAxis(radians(-look.y), Vec3(1, 0, 0)));
    }
}

ClipData make_all_faces(const HeadShape& shape) {
    ClipData clip;
    clip.name = "expressions";
    std::vector<std::vector<Vec2>> curves;  // of each target: times and weights
    float start = 0.6f;
    for (const Face& face : kFaces) {
        for (const auto& target : targets_of(face, shape)) {
            curves.resize(std::max(curves.size(), std::size_t{target.first} + 1));
            for (const Key& key : kRise) {
                curves[target.first].emplace_back(start + key.time, key.weight * target.second);
            }
        }
        start += kFaceTime;
    }
    for (std::size_t target = 0; target < curves.size(); ++target) {
        if (curves[target].empty()) {
            continue;
        }
        std::vector<float> times = {0};
        std::vector<float> weights = {0};
        for (const Vec2& key : curves[target]) {
            times.push_back(key.x);
            weights.push_back(key.y);
        }
        add_curve(clip, static_cast<std::uint16_t>(target), std::move(times), std::move(weights));
    }
    ClipSheet gaze;
    gaze.rotating = {2, 3};
    constexpr std::array<Vec2, 5> kLooks = {{{0, 0}, {4, 1}, {0, 0}, {-5, 0}, {1, -3}}};
    constexpr float kFixation = 1.9f;  // [s]
    constexpr float kSaccade = 0.045f;
    add_gaze(gaze, 0, kLooks[0]);
    int look = 0;
    for (float time = kFixation; time < start; time += kFixation) {
        add_gaze(gaze, time, kLooks[static_cast<std::size_t>(look) % kLooks.size()]);
        ++look;
        add_gaze(gaze, time + kSaccade, kLooks[static_cast<std::size_t>(look) % kLooks.size()]);
    }
    add_gaze(gaze, start + kFixation, kLooks[0]);
    clip.duration = gaze.times.back();
    clip.sheets.push_back(std::move(gaze));
    return clip;
}

ClipData make_blink() {
    ClipData clip;
    clip.name = "blink";
    constexpr float kPeriod = 3.7f;  // 17 a minute at rest (Bentivoglio et al. 1997)
    for (const char* const half : {"AU45_L", "AU45_R"}) {
        add_curve(
            clip, expression_index(half), {0, 1.0f, 1.09f, 1.13f, 1.33f, kPeriod},
            {0, 0, 1, 1, 0, 0});
    }
    return clip;
}

/// Motion of a speaker's mouth, lids, eyes and head.
ClipData make_talk(std::string_view says) {
    constexpr float kRate = 60.0f;  ///< keys per second
    constexpr std::uint64_t kSeed = 1;
    ClipData clip;
    clip.name = "talk";
    const SpeechTrack track = spell_utterance(says).track;
    const MouthTrack mouth = make_mouth_track(track);
    const EyeTrack eyes = make_eye_track(track.duration(), kSeed);
    const std::vector<std::string> names = expression_names();
    std::vector<GltfShape> shapes;
    for (const std::string& name : names) {
        shapes.push_back({name, name});
    }
    const std::vector<FaceLink> links = link_shapes(shapes);
    ClipSheet sheet;
    sheet.rotating = {0, 2, 3};
    for (const FaceLink& link : links) {
        sheet.morphing.push_back(static_cast<std::uint16_t>(link.shape));
    }
    std::ranges::sort(sheet.morphing);
    sheet.morphing.erase(
        std::unique(sheet.morphing.begin(), sheet.morphing.end()), sheet.morphing.end());
    const auto frames = static_cast<int>(std::ceil(track.duration() * kRate));
    for (int frame = 0; frame <= frames; ++frame) {
        const float time = static_cast<float>(frame) / kRate;
        const EyePose eye = eyes_at(eyes, time);
        std::vector<float> weights(shapes.size(), 0.0f);
        add_face_weights(links, mouth_at(mouth, time), eye, weights);
        for (const std::uint16_t shape : sheet.morphing) {
            sheet.weights.push_back(weights[shape]);
        }
        sheet.rotations.push_back(head_at(track, time, kSeed));
        add_gaze(sheet, time, {eye.yaw, eye.pitch});
    }
    clip.duration = sheet.times.back();
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

/// The same, with brows that rise and relax.
ClipData make_relax(const ClipData& talk) {
    ClipData clip = talk;
    clip.name = "relax";
    const float last = clip.duration;
    for (const char* const unit : {"AU1_L", "AU1_R", "AU2_L", "AU2_R"}) {
        std::vector<float> times;
        std::vector<float> weights;
        for (float start = 0.3f; start + 2.2f < last; start += 2.6f) {
            for (const Key& key : kRise) {
                times.push_back(start + key.time);
                weights.push_back(0.8f * key.weight);
            }
        }
        if (!times.empty()) {
            add_curve(clip, expression_index(unit), std::move(times), std::move(weights));
        }
    }
    return clip;
}

}  // namespace

std::vector<ClipData> make_head_clips(const HeadShape& shape) {
    std::vector<ClipData> clips;
    for (const Face& face : kFaces) {
        clips.push_back(make_face_clip(face, shape));
    }
    clips.push_back(make_all_faces(shape));
    clips.push_back(make_talk(shape.says));
    clips.push_back(make_relax(clips.back()));
    clips.push_back(make_blink());
    if (shape.grows_old) {
        ClipData& old = clips.emplace_back();
        old.name = "old";
        add_curve(old, expression_count(), {0, 1}, {1, 1});
    }
    return clips;
}

}  // namespace limn
