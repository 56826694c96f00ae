#include "content/bake/motion/marker_cleanup.h"

#include "content/bake/motion/motion_filter.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

// Techniques: char.mocap-cleanup

namespace limn {
namespace {

constexpr std::size_t kNoFrame = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMaxPrediction = 10;  ///< frames that a velocity is trusted for

Vec3& at(MarkerMotion& motion, std::size_t frame, std::size_t marker) {
    return motion.positions[frame * motion.markers() + marker];
}

/// The last two visible positions of a marker.
struct Track {
    std::array<std::size_t, 2> frames = {kNoFrame, kNoFrame};
    std::array<Vec3, 2> positions = {};

    void add(std::size_t frame, const Vec3& position) {
        frames = {frames[1], frame};
        positions = {positions[1], position};
    }
    [[nodiscard]] std::optional<Vec3> predict(std::size_t frame) const {
        if (frames[0] == kNoFrame || frame - frames[0] > kMaxPrediction) {
            return std::nullopt;
        }
        const float u =
            static_cast<float>(frame - frames[1]) / static_cast<float>(frames[1] - frames[0]);
        return positions[1] + u * (positions[1] - positions[0]);
    }
};

float squared_distance(const Vec3& a, const Vec3& b) {
    return glm::dot(a - b, a - b);
}

/// How much the sum of squared errors shrinks when two markers exchange their labels.
float gain_of_swap(const Vec3& a, const Vec3& b, const Vec3& predicted_a, const Vec3& predicted_b) {
    return squared_distance(a, predicted_a) + squared_distance(b, predicted_b)
           - squared_distance(a, predicted_b) - squared_distance(b, predicted_a);
}

/// Exchanges pairs of a frame, the most convincing first.
std::size_t
restore_frame(std::span<Vec3> frame, std::span<const std::optional<Vec3>> predicted, float margin) {
    std::size_t swaps = 0;
    while (swaps <= frame.size()) {
        float best = 2 * margin * margin;
        std::pair<std::size_t, std::size_t> pair;
        for (std::size_t a = 0; a < frame.size(); ++a) {
            for (std::size_t b = a + 1; b < frame.size(); ++b) {
                const bool is_known =
                    predicted[a] && predicted[b] && is_finite(frame[a]) && is_finite(frame[b]);
                const float gain =
                    is_known ? gain_of_swap(frame[a], frame[b], *predicted[a], *predicted[b]) : 0;
                if (gain > best) {
                    best = gain;
                    pair = {a, b};
                }
            }
        }
        if (pair.first == pair.second) {
            break;
        }
        std::swap(frame[pair.first], frame[pair.second]);
        ++swaps;
    }
    return swaps;
}

/// Frames [begin, end) in which a marker is hidden.
struct Gap {
    std::size_t begin = 0;
    std::size_t end = 0;
};

std::vector<Gap> find_gaps(MarkerMotion& motion, std::size_t marker) {
    std::vector<Gap> gaps;
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        if (is_finite(at(motion, f, marker))) {
            continue;
        }
        if (gaps.empty() || gaps.back().end != f) {
            gaps.push_back({f, f});
        }
        gaps.back().end = f + 1;
    }
    return gaps;
}

/// Value at `frame` of the polynomial through the points (Lagrange).
Vec3 interpolate(std::span<const std::pair<std::size_t, Vec3>> points, std::size_t frame) {
    Vec3 sum(0);
    for (const auto& [i, value] : points) {
        double weight = 1;
        for (const auto& [k, other] : points) {
            if (k != i) {
                weight *= (static_cast<double>(frame) - static_cast<double>(k))
                          / (static_cast<double>(i) - static_cast<double>(k));
            }
        }
        sum += static_cast<float>(weight) * value;
    }
    return sum;
}

/// The two visible positions nearest to the gap on each side.
std::vector<std::pair<std::size_t, Vec3>>
find_supports(MarkerMotion& motion, std::size_t marker, const Gap& gap) {
    std::vector<std::pair<std::size_t, Vec3>> supports;
    const auto add = [&](std::size_t f) {
        if (is_finite(at(motion, f, marker))) {
            supports.emplace_back(f, at(motion, f, marker));
        }
    };
    for (std::size_t f = gap.begin > 2 ? gap.begin - 2 : 0; f < gap.begin; ++f) {
        add(f);
    }
    for (std::size_t f = gap.end; f < std::min(gap.end + 2, motion.frames()); ++f) {
        add(f);
    }
    return supports;
}

/// Where the marker is in `frame` if it moved with the others of its segment since `known`.
std::optional<Vec3> carry_rigidly(
    MarkerMotion& motion, const MarkerSegment& segment, std::size_t marker, std::size_t known,
    std::size_t frame) {
    std::vector<Vec3> from;
    std::vector<Vec3> to;
    for (const std::uint32_t m : segment) {
        if (m != marker && is_finite(at(motion, known, m)) && is_finite(at(motion, frame, m))) {
            from.push_back(at(motion, known, m));
            to.push_back(at(motion, frame, m));
        }
    }
    const Result<Affine> moved = fit_rigid(from, to);
    return moved ? std::optional(transform_point(*moved, at(motion, known, marker))) : std::nullopt;
}

/// The positions in a gap between visible frames by the segment; nullopt if it is not seen well.
std::optional<std::vector<Vec3>> fill_rigidly(
    MarkerMotion& motion, const MarkerSegment& segment, std::size_t marker, const Gap& gap) {
    std::vector<Vec3> filled;
    const auto steps = static_cast<float>(gap.end - gap.begin + 1);
    for (std::size_t f = gap.begin; f < gap.end; ++f) {
        const auto before = carry_rigidly(motion, segment, marker, gap.begin - 1, f);
        const auto after = carry_rigidly(motion, segment, marker, gap.end, f);
        if (!before || !after) {
            return std::nullopt;
        }
        filled.push_back(glm::mix(*before, *after, static_cast<float>(f - gap.begin + 1) / steps));
    }
    return filled;
}

std::vector<Vec3> fill_gap(
    MarkerMotion& motion, std::span<const MarkerSegment> segments, std::size_t marker,
    const Gap& gap) {
    const std::size_t count = gap.end - gap.begin;
    if (gap.begin == 0 || gap.end == motion.frames()) {
        return std::vector<Vec3>(
            count,
            gap.begin == 0 ? at(motion, gap.end, marker) : at(motion, gap.begin - 1, marker));
    }
    for (const MarkerSegment& segment : segments) {
        const bool has = std::find(segment.begin(), segment.end(), marker) != segment.end();
        auto filled = has ? fill_rigidly(motion, segment, marker, gap) : std::nullopt;
        if (filled) {
            return *std::move(filled);
        }
    }
    const auto supports = find_supports(motion, marker, gap);
    std::vector<Vec3> filled;
    for (std::size_t f = gap.begin; f < gap.end; ++f) {
        filled.push_back(interpolate(supports, f));
    }
    return filled;
}

}  // namespace

std::size_t restore_swaps(MarkerMotion& motion, float margin) {
    const std::size_t count = motion.markers();
    std::vector<Track> tracks(count);
    std::size_t swaps = 0;
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        std::vector<std::optional<Vec3>> predicted;
        for (const Track& track : tracks) {
            predicted.push_back(track.predict(f));
        }
        const std::span<Vec3> frame = std::span(motion.positions).subspan(f * count, count);
        swaps += restore_frame(frame, predicted, margin);
        for (std::size_t m = 0; m < count; ++m) {
            if (is_finite(frame[m])) {
                tracks[m].add(f, frame[m]);
            }
        }
    }
    return swaps;
}

std::size_t fill_marker_gaps(
    MarkerMotion& motion, std::span<const MarkerSegment> segments, std::size_t max_frames) {
    const MarkerMotion recorded = motion;
    MarkerMotion source = recorded;
    std::size_t filled = 0;
    for (std::size_t m = 0; m < motion.markers(); ++m) {
        for (const Gap& gap : find_gaps(source, m)) {
            const std::size_t count = gap.end - gap.begin;
            if (count > max_frames || count == motion.frames()) {
                continue;
            }
            const std::vector<Vec3> positions = fill_gap(source, segments, m, gap);
            for (std::size_t f = gap.begin; f < gap.end; ++f) {
                at(motion, f, m) = positions[f - gap.begin];
            }
            filled += count;
        }
    }
    return filled;
}

void smooth_markers(MarkerMotion& motion, float cutoff) {
    for (std::size_t m = 0; m < motion.markers(); ++m) {
        for (std::size_t begin = 0; begin < motion.frames(); ++begin) {
            std::vector<Vec3> path;
            for (std::size_t f = begin; f < motion.frames() && is_finite(at(motion, f, m)); ++f) {
                path.push_back(at(motion, f, m));
            }
            low_pass(std::span(path), motion.rate, cutoff);
            for (std::size_t i = 0; i < path.size(); ++i) {
                at(motion, begin + i, m) = path[i];
            }
            begin += path.size();
        }
    }
}

CleanupCounts clean_markers(
    MarkerMotion& motion, std::span<const MarkerSegment> segments, const MarkerCleanup& options) {
    CleanupCounts counts;
    if (options.swap_margin > 0) {
        counts.swaps = restore_swaps(motion, options.swap_margin);
    }
    counts.filled = fill_marker_gaps(
        motion, segments, static_cast<std::size_t>(options.max_gap * motion.rate + 0.5f));
    counts.unfilled = static_cast<std::size_t>(
        std::count_if(motion.positions.begin(), motion.positions.end(), [](const Vec3& p) {
            return !is_finite(p);
        }));
    smooth_markers(motion, options.cutoff);
    return counts;
}

}  // namespace limn
