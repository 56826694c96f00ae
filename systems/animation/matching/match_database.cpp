#include "systems/animation/matching/match_database.h"

#include "ecs/base/log.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/ik/joint_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: char.motion-select

namespace limn {
namespace {

constexpr int kSmoothRows = 10;  // to each side, of a root that follows hips
constexpr int kSmoothPasses = 2;
constexpr float kMinSpread = 1e-4f;  // of a feature that is always the same

const ClipData* asset_clip(const Assets& assets, ClipId id) {
    return id.index < assets.clips.size() ? &assets.clips[id.index] : nullptr;
}

bool is_below(const std::vector<std::uint16_t>& joints, std::size_t count) {
    return std::all_of(joints.begin(), joints.end(), [=](std::uint16_t j) { return j < count; });
}

bool fits_skeleton(const ClipData& clip, const SkeletonData& skeleton) {
    const std::size_t count = skeleton.joints.size();
    return std::all_of(clip.sheets.begin(), clip.sheets.end(), [=](const ClipSheet& sheet) {
        return is_below(sheet.rotating, count) && is_below(sheet.translating, count)
               && is_below(sheet.scaling, count);
    });
}

std::size_t rows_of(float duration) {
    return static_cast<std::size_t>(std::max(std::floor(duration / kMatchStep + 1e-3f), 0.0f)) + 1;
}

Vec2 turned(const Vec2& p, float yaw) {
    return compose({{0, 0}, yaw}, {p, 0}).way;
}

void add_joints(const ClipData& clip, MatchDatabase& database) {
    for (const ClipSheet& sheet : clip.sheets) {
        auto& turning = database.turning;
        auto& moving = database.moving;
        turning.insert(turning.end(), sheet.rotating.begin(), sheet.rotating.end());
        moving.insert(moving.end(), sheet.translating.begin(), sheet.translating.end());
    }
}

void sort_unique(std::vector<std::uint16_t>& joints) {
    std::sort(joints.begin(), joints.end());
    joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
}

/// Fits a parabola through neighbors, fewer at the ends (Savitzky, Golay 1964): slow turns stay,
/// the sway of steps does not.
void smooth(std::vector<GroundMove>& track) {
    std::vector<GroundMove> before;
    const auto last = static_cast<int>(track.size()) - 1;
    for (int pass = 0; pass < kSmoothPasses; ++pass) {
        before = track;
        for (int i = 0; i <= last; ++i) {
            const int reach = std::min({kSmoothRows, i, last - i});
            const auto m = static_cast<float>(reach);
            const float sum = (2 * m - 1) * (2 * m + 1) * (2 * m + 3) / 3;
            GroundMove mean{{0, 0}, 0};
            for (int k = -reach; k <= reach; ++k) {
                const GroundMove& at = before[static_cast<std::size_t>(i + k)];
                const float weight = (3 * m * (m + 1) - 1 - 5 * static_cast<float>(k * k)) / sum;
                mean.way += weight * at.way;
                mean.yaw += weight * at.yaw;
            }
            track[static_cast<std::size_t>(i)] = mean;
        }
    }
}

/// The pose in the space of the clip.
void sample_in_place(
    const SkeletonData& skeleton, const ClipData& clip, float time, LocalPose& pose,
    std::vector<float>& weights) {
    pose = skeleton.rest;
    std::size_t morphs = 0;
    for (const ClipSheet& sheet : clip.sheets) {
        for (const std::uint16_t morph : sheet.morphing) {
            morphs = std::max<std::size_t>(morphs, morph + 1u);
        }
    }
    weights.assign(morphs, 0.0f);
    sample_clip(clip, time, pose, weights);
}

float weight_of(const MatchWeights& weights, std::size_t part) {
    return part < 6 ? weights.trajectory : part < 10 ? weights.feet : weights.hips;
}

/// Mean and scale of each number, the same scale for all of a feature.
void measure_spread(
    std::span<const MatchRow> rows, const MatchWeights& weights, MatchDatabase& database) {
    const auto count = static_cast<double>(rows.size());
    std::array<double, kMatchFeatures> mean{};
    std::array<double, kMatchFeatures> variance{};
    for (const MatchRow& row : rows) {
        for (std::size_t k = 0; k < kMatchFeatures; ++k) {
            mean[k] += static_cast<double>(row[k]) / count;
        }
    }
    for (const MatchRow& row : rows) {
        for (std::size_t k = 0; k < kMatchFeatures; ++k) {
            variance[k] += square(static_cast<double>(row[k]) - mean[k]) / count;
        }
    }
    for (std::size_t part = 0; part < kMatchFeatureParts.size(); ++part) {
        const auto [first, size] = kMatchFeatureParts[part];
        double sum = 0;
        for (std::size_t k = first; k < first + size; ++k) {
            sum += variance[k] / static_cast<double>(size);
        }
        const auto spread = static_cast<float>(std::sqrt(sum));
        const float weight = std::max(finite_or(weight_of(weights, part), 1.0f), 0.0f);
        for (std::size_t k = first; k < first + size; ++k) {
            database.mean[k] = static_cast<float>(mean[k]);
            database.scale[k] = weight / std::max(spread, kMinSpread);
        }
    }
}

}  // namespace

const ClipData& MatchDatabase::clip(const Assets& assets, std::uint32_t index) const {
    const MatchClip& found = clips[index];
    return found.is_take ? takes[found.clip.index].clip : assets.clips[found.clip.index];
}

MatchPlace MatchDatabase::place_of(std::uint32_t row) const {
    std::uint32_t clip = 0;
    while (clip + 1 < clips.size() && row >= clips[clip].first_row + clips[clip].rows) {
        ++clip;
    }
    return {clip, static_cast<float>(row - clips[clip].first_row) * kMatchStep};
}

const MatchRow& MatchDatabase::frame_at(const MatchPlace& place) const {
    const std::vector<MatchRow>& frames = clips[place.clip].frames;
    const auto frame =
        static_cast<std::size_t>(std::lround(std::max(place.time, 0.0f) / kMatchStep));
    return frames[std::min(frame, frames.size() - 1)];
}

GroundMove root_of(const MatchClip& clip, float time) {
    if (clip.root.empty()) {
        return {};
    }
    const auto last = static_cast<float>(clip.root.size() - 1);
    const float at = std::clamp(time / kMatchStep, 0.0f, last);
    const auto i = std::min(static_cast<std::size_t>(at), clip.root.size() - 1);
    const std::size_t next = std::min(i + 1, clip.root.size() - 1);
    const float u = at - static_cast<float>(i);
    return {
        glm::mix(clip.root[i].way, clip.root[next].way, u),
        glm::mix(clip.root[i].yaw, clip.root[next].yaw, u)};
}

void sample_match_pose(
    const MatchDatabase& database, const Assets& assets, const MatchPlace& place, LocalPose& pose) {
    thread_local std::vector<float> weights;
    const ClipData& clip = database.clip(assets, place.clip);
    std::size_t morphs = 0;
    for (const ClipSheet& sheet : clip.sheets) {
        for (const std::uint16_t morph : sheet.morphing) {
            morphs = std::max<std::size_t>(morphs, morph + 1u);
        }
    }
    weights.assign(morphs, 0.0f);
    sample_clip(clip, place.time, pose, weights);
    const GroundMove back = inverse(root_of(database.clips[place.clip], place.time));
    const Quat turn = rotation_about({0, 1, 0}, back.yaw);
    pose.rotations[0] = turn * pose.rotations[0];
    pose.translations[0] = Vec3(back.way.x, 0, back.way.y) + turn * pose.translations[0];
}

std::vector<GroundMove> find_clip_root(
    const SkeletonData& skeleton, const WalkBody& body, const ClipData& clip, float step) {
    std::vector<GroundMove> track;
    std::vector<float> weights;
    LocalPose pose;
    const auto rows = static_cast<std::size_t>(std::floor(clip.duration / step + 1e-3f)) + 1;
    const std::uint16_t hips = body.can_walk ? body.hips : std::uint16_t{0};
    const JointPlace rest = find_place(skeleton, skeleton.rest, hips);
    float yaw = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        sample_in_place(skeleton, clip, static_cast<float>(i) * step, pose, weights);
        const JointPlace place = find_place(skeleton, pose, hips);
        const Quat turn = place.rotation * glm::conjugate(rest.rotation);
        const float now = 2 * std::atan2(turn.y, turn.w);
        yaw += std::remainder(now - yaw, 2 * kPi);
        const Vec2 offset = turned({rest.position.x, rest.position.z}, yaw);
        track.push_back({Vec2(place.position.x, place.position.z) - offset, yaw});
    }
    smooth(track);
    return track;
}

std::vector<MatchRow> find_match_features(
    const SkeletonData& skeleton, const WalkBody& body, const ClipData& clip,
    std::span<const GroundMove> root) {
    struct Points {
        std::array<Vec3, 3> at{};  ///< feet and hips
    };
    const std::size_t frames = root.size();
    if (frames <= kMatchAhead.back()) {
        return {};
    }
    std::vector<Points> points(frames);
    std::vector<float> weights;
    LocalPose pose;
    const std::array<std::uint16_t, 3> joints = {
        body.can_walk ? body.legs[0].foot : std::uint16_t{0},
        body.can_walk ? body.legs[1].foot : std::uint16_t{0},
        body.can_walk ? body.hips : std::uint16_t{0}};
    for (std::size_t i = 0; i < frames; ++i) {
        sample_in_place(skeleton, clip, static_cast<float>(i) * kMatchStep, pose, weights);
        for (std::size_t k = 0; k < joints.size(); ++k) {
            points[i].at[k] = find_place(skeleton, pose, joints[k]).position;
        }
    }
    std::vector<GroundMove> path(root.begin(), root.end());
    const GroundMove last = compose(inverse(path[frames - 2]), path[frames - 1]);
    while (path.size() < frames + kMatchAhead.back()) {
        path.push_back(compose(path.back(), last));
    }
    std::vector<MatchRow> rows(frames);
    for (std::size_t i = 0; i < frames; ++i) {
        MatchRow& row = rows[i];
        const GroundMove back = inverse(root[i]);
        const Quat turn = rotation_about({0, 1, 0}, back.yaw);
        for (std::size_t k = 0; k < kMatchAhead.size(); ++k) {
            const GroundMove ahead = compose(back, path[i + kMatchAhead[k]]);
            row[4 * k] = ahead.way.x;
            row[4 * k + 1] = ahead.way.y;
            row[4 * k + 2] = std::sin(ahead.yaw);
            row[4 * k + 3] = std::cos(ahead.yaw);
        }
        const std::size_t earlier = i > 0 ? i - 1 : i;
        const std::size_t later = std::min(i + 1, frames - 1);
        const float span = static_cast<float>(later - earlier) * kMatchStep;
        for (std::size_t k = 0; k < joints.size(); ++k) {
            const Vec3 place = Vec3(back.way.x, 0, back.way.y) + turn * points[i].at[k];
            const Vec3 velocity = turn * (points[later].at[k] - points[earlier].at[k]) / span;
            for (int axis = 0; axis < 3; ++axis) {
                const auto a = static_cast<std::size_t>(axis);
                if (k < 2) {
                    row[kMatchFeet + 3 * k + a] = place[axis];
                }
                row[kMatchFeet + 6 + 3 * k + a] = velocity[axis];
            }
        }
    }
    return rows;
}

MatchDatabase make_match_database(
    const SkeletonData& skeleton, const Assets& assets, std::span<const ClipId> clips,
    std::vector<MatchTake> takes, const MatchWeights& weights) {
    MatchDatabase database;
    database.body = find_walk_body(skeleton);
    database.takes = std::move(takes);
    std::vector<MatchRow> rows;
    const auto add = [&](const ClipData& clip, ClipId id, bool is_take) {
        MatchClip entry;
        entry.clip = id;
        entry.is_take = is_take;
        entry.duration = clip.duration;
        if (is_take) {
            const auto& track = database.takes[id.index].root;
            const auto every = static_cast<std::size_t>(std::lround(kMatchStep / kTakeKey));
            for (std::size_t i = 0; i < track.size(); i += every) {
                entry.root.push_back(track[i]);
            }
        } else {
            entry.root = find_clip_root(skeleton, database.body, clip, kMatchStep);
        }
        entry.frames = find_match_features(skeleton, database.body, clip, entry.root);
        entry.first_row = rows.size();
        entry.rows = entry.frames.size() - kMatchAhead.back();
        rows.insert(
            rows.end(), entry.frames.begin(),
            entry.frames.begin() + static_cast<std::ptrdiff_t>(entry.rows));
        for (const ClipContact& contact : clip.contacts) {
            for (std::size_t foot = 0; foot < 2; ++foot) {
                const WalkLeg& leg = database.body.legs[foot];
                if (contact.joint == leg.foot || contact.joint == leg.toes) {
                    entry.contacts[foot].push_back(contact);
                }
            }
        }
        add_joints(clip, database);
        database.clips.push_back(std::move(entry));
    };
    for (const ClipId id : clips) {
        const ClipData* const clip = asset_clip(assets, id);
        if (clip == nullptr) {
            log_warn("motion match: clip {} is missing; it is left out", id.index);
        } else if (!fits_skeleton(*clip, skeleton)) {
            log_warn(
                "motion match: clip {} has joints beyond the {} of skeleton {}; it is left out",
                clip->name, skeleton.joints.size(), skeleton.name);
        } else if (rows_of(clip->duration) <= kMatchAhead.back()) {
            log_warn(
                "motion match: clip {} is {} s long, must be longer than 1 s; it is left out",
                clip->name, clip->duration);
        } else {
            add(*clip, id, false);
        }
    }
    for (std::uint32_t i = 0; i < database.takes.size(); ++i) {
        if (rows_of(database.takes[i].clip.duration) > kMatchAhead.back()) {
            add(database.takes[i].clip, {i}, true);
        }
    }
    sort_unique(database.turning);
    sort_unique(database.moving);
    if (rows.empty()) {
        return database;
    }
    measure_spread(rows, weights, database);
    const auto normalize = [&](std::vector<MatchRow>& list) {
        for (MatchRow& row : list) {
            for (std::size_t k = 0; k < kMatchFeatures; ++k) {
                row[k] = (row[k] - database.mean[k]) * database.scale[k];
            }
        }
    };
    normalize(rows);
    for (MatchClip& clip : database.clips) {
        normalize(clip.frames);
    }
    database.rows = make_match_rows(rows);
    return database;
}

const MatchDatabase* MatchDatabases::find(SkeletonId skeleton, const MotionMatch& match) const {
    for (const Entry& entry : entries) {
        if (entry.skeleton == skeleton && entry.walk == match.walk && entry.clips == match.clips
            && entry.weights == weights_of(match)) {
            return entry.database.get();
        }
    }
    return nullptr;
}

}  // namespace limn
