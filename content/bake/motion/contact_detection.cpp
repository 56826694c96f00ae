#include "content/bake/motion/contact_detection.h"

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/motion_filter.h"
#include "ecs/base/check.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.walk-retarget

namespace limn {
namespace {

constexpr float kNearby = 0.75f;  ///< how long before and after the lowest point is sought [s]

/// Speed of each sample by central differences [m/s].
std::vector<float> speeds_of(const std::vector<Vec3>& path, float rate) {
    std::vector<float> speeds(path.size(), 0.0f);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const std::size_t before = i > 0 ? i - 1 : 0;
        const std::size_t after = std::min(i + 1, path.size() - 1);
        if (after > before) {
            speeds[i] = glm::distance(path[after], path[before]) * rate
                        / static_cast<float>(after - before);
        }
    }
    return speeds;
}

/// Height of each sample above the lowest one nearby [m].
std::vector<float> heights_of(const std::vector<Vec3>& path, float rate) {
    const auto reach = static_cast<std::size_t>(kNearby * rate) + 1;
    std::vector<float> heights;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto first = path.begin() + static_cast<std::ptrdiff_t>(i > reach ? i - reach : 0);
        const auto last =
            path.begin() + static_cast<std::ptrdiff_t>(std::min(i + reach + 1, path.size()));
        const auto lowest =
            std::min_element(first, last, [](const Vec3& a, const Vec3& b) { return a.y < b.y; });
        heights.push_back(path[i].y - lowest->y);
    }
    return heights;
}

/// Frames [begin, last] of a contact.
struct Span {
    std::size_t begin = 0;
    std::size_t last = 0;
};

std::vector<Span> find_spans(
    const std::vector<float>& speeds, const std::vector<float>& heights, float speed, float height,
    float release) {
    std::vector<Span> spans;
    bool is_planted = false;
    for (std::size_t f = 0; f < speeds.size(); ++f) {
        const float factor = is_planted ? release : 1.0f;
        const bool stays = speeds[f] < factor * speed && heights[f] < factor * height;
        if (stays && !is_planted) {
            spans.push_back({f, f});
        } else if (stays) {
            spans.back().last = f;
        }
        is_planted = stays;
    }
    return spans;
}

/// Joins spans with short gaps in between, then drops short ones.
std::vector<Span>
keep_long(const std::vector<Span>& spans, std::size_t min_gap, std::size_t min_length) {
    std::vector<Span> joined;
    for (const Span& span : spans) {
        if (!joined.empty() && span.begin - joined.back().last <= min_gap) {
            joined.back().last = span.last;
        } else {
            joined.push_back(span);
        }
    }
    std::erase_if(joined, [&](const Span& span) { return span.last - span.begin < min_length; });
    return joined;
}

}  // namespace

std::vector<ClipContact> detect_contacts(
    const SkeletonData& skeleton, const MotionFrames& frames, std::span<const std::uint16_t> joints,
    const ContactOptions& options) {
    LIMN_CHECK(options.release >= 1);
    const BodyJoints body = find_body_joints(skeleton);
    const float found_leg = find_leg_length(skeleton, body);
    const float leg = found_leg > 0 ? found_leg : 0.85f;
    const std::uint16_t root = find_body_root(skeleton, body);
    float travelled = 0;
    for (const float speed : speeds_of(joint_path(skeleton, frames, root), frames.rate)) {
        travelled += speed / static_cast<float>(std::max<std::size_t>(frames.frames(), 1));
    }
    const float speed = std::max(options.speed * leg, options.root_speed * travelled);
    std::vector<ClipContact> contacts;
    for (const std::uint16_t joint : joints) {
        std::vector<Vec3> path = joint_path(skeleton, frames, joint);
        low_pass(std::span(path), frames.rate, options.cutoff);
        const std::vector<Span> spans = find_spans(
            speeds_of(path, frames.rate), heights_of(path, frames.rate), speed,
            options.height * leg, options.release);
        for (const Span& span : keep_long(
                 spans, static_cast<std::size_t>(options.min_flight * frames.rate),
                 static_cast<std::size_t>(options.min_contact * frames.rate))) {
            contacts.push_back(
                {joint, static_cast<float>(span.begin) / frames.rate,
                 static_cast<float>(span.last) / frames.rate});
        }
    }
    std::ranges::stable_sort(contacts, {}, &ClipContact::begin);
    return contacts;
}

}  // namespace limn
