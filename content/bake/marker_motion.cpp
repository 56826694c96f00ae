#include "content/bake/marker_motion.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Techniques: face.head-stabilise, face.mocap-drive

namespace limn {
namespace {

using MarkerDVec3 = glm::dvec3;
using Matrix4 = std::array<std::array<double, 4>, 4>;

constexpr std::size_t kNeighbors = 4;  ///< that a hidden marker follows
constexpr int kSweeps = 32;            ///< of Jacobi's method, far more than 4 x 4 needs
constexpr double kMinSpread = 1e-10;  ///< of points in their second direction, relative and squared
constexpr double kSeenSpread = 2.5e-3;  ///< likewise, of the markers of a head that are seen

/// Rotates rows and columns p and q of a symmetric matrix so that element (p, q) is 0.
void rotate(Matrix4& m, Matrix4& vectors, std::size_t p, std::size_t q) {
    if (m[p][q] == 0.0) {
        return;
    }
    const double half = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    const double t = std::copysign(1.0, half) / (std::abs(half) + std::sqrt(half * half + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0);
    const double s = t * c;
    for (std::size_t k = 0; k < 4; ++k) {
        const double kp = m[k][p];
        const double kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const double pk = m[p][k];
        const double qk = m[q][k];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
        const double vp = vectors[k][p];
        const double vq = vectors[k][q];
        vectors[k][p] = c * vp - s * vq;
        vectors[k][q] = s * vp + c * vq;
    }
}

/// The unit eigenvector of the largest eigenvalue of a symmetric matrix, by Jacobi's method.
std::array<double, 4> largest_eigenvector(Matrix4 m) {
    Matrix4 vectors{};
    for (std::size_t k = 0; k < 4; ++k) {
        vectors[k][k] = 1.0;
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (std::size_t p = 0; p < 4; ++p) {
            for (std::size_t q = p + 1; q < 4; ++q) {
                rotate(m, vectors, p, q);
            }
        }
    }
    std::size_t largest = 0;
    for (std::size_t k = 1; k < 4; ++k) {
        largest = m[k][k] > m[largest][largest] ? k : largest;
    }
    return {vectors[0][largest], vectors[1][largest], vectors[2][largest], vectors[3][largest]};
}

MarkerDVec3 mean_of(std::span<const Vec3> points) {
    MarkerDVec3 sum(0);
    for (const Vec3& p : points) {
        sum += MarkerDVec3(p);
    }
    return sum / static_cast<double>(points.size());
}

/// Whether points are collinear or coincide: their spread in the second direction, relative and
/// squared, is at most `spread`.
bool is_line(std::span<const Vec3> points, const MarkerDVec3& mean, double spread = kMinSpread) {
    MarkerDVec3 farthest(0);
    for (const Vec3& p : points) {
        const MarkerDVec3 out = MarkerDVec3(p) - mean;
        farthest = glm::dot(out, out) > glm::dot(farthest, farthest) ? out : farthest;
    }
    const double size = glm::dot(farthest, farthest);
    double wide = 0;
    for (const Vec3& p : points) {
        const MarkerDVec3 across = glm::cross(MarkerDVec3(p) - mean, farthest);
        wide = std::max(wide, glm::dot(across, across));
    }
    return !(wide > spread * size * size);
}

/// The visible markers that are nearest at rest, except the marker itself.
std::vector<std::size_t>
find_neighbors(std::span<const Vec3> rest, std::span<const Vec3> frame, std::size_t marker) {
    std::vector<std::size_t> visible;
    for (std::size_t m = 0; m < frame.size(); ++m) {
        if (m != marker && is_finite(frame[m])) {
            visible.push_back(m);
        }
    }
    const std::size_t kept = std::min(kNeighbors, visible.size());
    std::partial_sort(
        visible.begin(), visible.begin() + static_cast<std::ptrdiff_t>(kept), visible.end(),
        [&](std::size_t a, std::size_t b) {
            const float to_a = glm::distance(rest[a], rest[marker]);
            const float to_b = glm::distance(rest[b], rest[marker]);
            return to_a != to_b ? to_a < to_b : a < b;
        });
    visible.resize(kept);
    return visible;
}

/// Position of a marker that moves with its neighbors, weighted by inverse distance; at rest
/// without any.
Vec3 carried_by_neighbors(
    std::span<const Vec3> rest, std::span<const Vec3> frame, std::size_t marker) {
    Vec3 sum(0);
    float weights = 0.0f;
    for (const std::size_t m : find_neighbors(rest, frame, marker)) {
        const float weight = 1.0f / std::max(glm::distance(rest[m], rest[marker]), 1e-6f);
        sum += weight * (frame[m] - rest[m]);
        weights += weight;
    }
    return weights > 0.0f ? rest[marker] + sum / weights : rest[marker];
}

/// Of a rotation and a translation.
Affine rigid_inverse(const Affine& rigid) {
    Affine back;
    for (int i = 0; i < 3; ++i) {
        const Vec3 column(rigid.row[0][i], rigid.row[1][i], rigid.row[2][i]);
        const Vec3 shift(rigid.row[0].w, rigid.row[1].w, rigid.row[2].w);
        back.row[i] = Vec4(column, -glm::dot(column, shift));
    }
    return back;
}

}  // namespace

Result<Affine> fit_rigid(std::span<const Vec3> from, std::span<const Vec3> to) {
    LIMN_CHECK(from.size() == to.size());
    if (from.size() < 3) {
        return fail("found {} markers on the head, expected at least 3", from.size());
    }
    const bool finite =
        std::all_of(from.begin(), from.end(), [](const Vec3& p) { return is_finite(p); })
        && std::all_of(to.begin(), to.end(), [](const Vec3& p) { return is_finite(p); });
    if (!finite) {
        return fail("a marker on the head is missing");
    }
    const MarkerDVec3 from_mean = mean_of(from);
    const MarkerDVec3 to_mean = mean_of(to);
    if (is_line(from, from_mean) || is_line(to, to_mean)) {
        return fail("the markers on the head lie in a line");
    }
    std::array<std::array<double, 3>, 3> s{};  // sums of products of coordinates
    for (std::size_t i = 0; i < from.size(); ++i) {
        const MarkerDVec3 a = MarkerDVec3(from[i]) - from_mean;
        const MarkerDVec3 b = MarkerDVec3(to[i]) - to_mean;
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) {
                s[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] += a[j] * b[k];
            }
        }
    }
    const std::array<double, 4> q = largest_eigenvector(
        {{{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
          {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
          {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
          {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}}});
    const glm::dmat3 turn = glm::mat3_cast(glm::dquat(q[0], q[1], q[2], q[3]));
    const MarkerDVec3 shift = to_mean - turn * from_mean;
    Affine fitted;
    for (int i = 0; i < 3; ++i) {
        fitted.row[i] = Vec4(glm::dvec4(turn[0][i], turn[1][i], turn[2][i], shift[i]));
    }
    return fitted;
}

void fill_gaps(MarkerMotion& motion, std::span<const Vec3> rest) {
    LIMN_CHECK(rest.size() == motion.markers());
    const MarkerMotion recorded = motion;
    const std::size_t count = motion.markers();
    const std::size_t frames = motion.frames();
    const auto frame = [&](std::size_t f) {
        return std::span(recorded.positions).subspan(f * count, count);
    };
    for (std::size_t m = 0; m < count; ++m) {
        const auto is_visible = [&](std::size_t f) { return is_finite(frame(f)[m]); };
        const auto difference = [&](std::size_t f) {
            return frame(f)[m] - carried_by_neighbors(rest, frame(f), m);
        };
        for (std::size_t f = 0; f < frames; ++f) {
            if (is_visible(f)) {
                continue;
            }
            std::size_t next = f;
            while (next < frames && !is_visible(next)) {
                ++next;
            }
            const bool has_last = f > 0;
            const bool has_next = next < frames;
            const Vec3 first = has_last ? difference(f - 1) : has_next ? difference(next) : Vec3(0);
            const Vec3 second = has_next ? difference(next) : first;
            const auto steps = static_cast<float>(next - f + 1);
            for (std::size_t g = f; g < next; ++g) {
                const float t = static_cast<float>(g - f + 1) / steps;
                motion.positions[g * count + m] =
                    carried_by_neighbors(rest, frame(g), m) + glm::mix(first, second, t);
            }
            f = next;
        }
    }
}

std::vector<Vec3> sample_markers(const MarkerMotion& motion, float time) {
    LIMN_CHECK(motion.frames() > 0);
    const float last = static_cast<float>(motion.frames() - 1);
    const float at = std::clamp(time * motion.rate, 0.0f, last);
    const auto frame = static_cast<std::size_t>(at);
    const std::size_t next = std::min(frame + 1, motion.frames() - 1);
    std::vector<Vec3> positions;
    for (std::size_t m = 0; m < motion.markers(); ++m) {
        positions.push_back(glm::mix(
            motion.positions[frame * motion.markers() + m],
            motion.positions[next * motion.markers() + m], at - static_cast<float>(frame)));
    }
    return positions;
}

Result<std::vector<Affine>> stabilize_head(
    MarkerMotion& motion, std::span<const Vec3> rest, std::span<const std::uint32_t> head) {
    LIMN_CHECK(rest.size() == motion.markers());
    std::vector<Vec3> at_rest;
    for (const std::uint32_t m : head) {
        LIMN_CHECK(m < rest.size());
        at_rest.push_back(rest[m]);
    }
    LIMN_TRY(fit_rigid(at_rest, at_rest));
    std::vector<Affine> heads(motion.frames());
    std::vector<bool> is_seen;
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        std::vector<Vec3> visible;
        std::vector<Vec3> now;
        for (const std::uint32_t m : head) {
            const Vec3& p = motion.positions[f * motion.markers() + m];
            if (is_finite(p)) {
                visible.push_back(rest[m]);
                now.push_back(p);
            }
        }
        // Nearly on a line, noise of the markers would turn the head by degrees.
        const bool is_wide =
            now.size() == head.size() || !is_line(visible, mean_of(visible), kSeenSpread);
        const Result<Affine> fit =
            is_wide ? fit_rigid(visible, now) : Result<Affine>(fail("found markers on a line"));
        is_seen.push_back(fit.ok());
        heads[f] = fit ? *fit : Affine{};
    }
    if (std::ranges::find(is_seen, true) == is_seen.end()) {
        return fail("found no frame with three markers on the head that are visible");
    }
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        std::size_t next = f;
        while (next < motion.frames() && !is_seen[next]) {
            ++next;
        }
        const bool has_next = next < motion.frames();
        const Affine last = f > 0 ? heads[f - 1] : heads[next];
        for (std::size_t g = f; g < next; ++g) {
            const float t = static_cast<float>(g - f + 1) / static_cast<float>(next - f + 1);
            std::vector<Vec3> between;
            for (const Vec3& p : at_rest) {
                const Vec3 from = transform_point(last, p);
                between.push_back(
                    has_next ? glm::mix(from, transform_point(heads[next], p), t) : from);
            }
            const Result<Affine> fit = fit_rigid(at_rest, between);
            heads[g] = fit ? *fit : last;
        }
        f = next;
    }
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        const Affine back = rigid_inverse(heads[f]);
        for (std::size_t m = 0; m < motion.markers(); ++m) {
            Vec3& p = motion.positions[f * motion.markers() + m];
            p = transform_point(back, p);
        }
    }
    return heads;
}

}  // namespace limn
