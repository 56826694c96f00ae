#include "content/bake/motion/marker_joints.h"

#include "content/bake/motion/body_frame.h"
#include "content/bake/motion/foot_pins.h"
#include "ecs/base/check.h"
#include "ecs/base/limb_reach.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.marker-to-joint

namespace limn {
namespace {

/// A rigid motion from rest.
struct Placement {
    Quat turn = {1, 0, 0, 0};
    Vec3 shift = Vec3(0);  ///< p moves to turn * p + shift

    [[nodiscard]] Vec3 place(const Vec3& p) const { return turn * p + shift; }
};

class MarkerFitter {
  public:
    MarkerFitter(const SkeletonData& skeleton, std::span<const BodyMarker> markers)
        : skeleton_(skeleton), rest_(find_rest_matrices(skeleton)),
          rest_rotations_(find_frame_rotations(skeleton, skeleton.rest.rotations)),
          markers_(markers), of_joint_(skeleton.joints.size()),
          is_top_(skeleton.joints.size(), false) {
        for (std::size_t m = 0; m < markers.size(); ++m) {
            if (markers[m].joint != BodyMarker::kUnused) {
                LIMN_CHECK(markers[m].joint < of_joint_.size());
                of_joint_[markers[m].joint].push_back(m);
            }
        }
        std::vector<bool> is_below(of_joint_.size(), false);
        for (std::size_t j = 0; j < of_joint_.size(); ++j) {
            const std::int32_t parent = skeleton.parents[j];
            is_below[j] = parent >= 0
                          && (is_below[static_cast<std::size_t>(parent)]
                              || is_top_[static_cast<std::size_t>(parent)]);
            is_top_[j] = !is_below[j] && !of_joint_[j].empty();
        }
    }

    [[nodiscard]] bool has_markers() const {
        return std::find(is_top_.begin(), is_top_.end(), true) != is_top_.end();
    }

    /// Appends a frame.
    void fit(std::span<const Vec3> positions, MotionFrames& frames) {
        std::vector<Placement> placed;
        for (std::size_t j = 0; j < of_joint_.size(); ++j) {
            const std::int32_t parent = skeleton_.parents[j];
            const Placement outer =
                parent < 0 ? Placement{} : placed[static_cast<std::size_t>(parent)];
            placed.push_back(place_joint(j, outer, positions));
            measure(j, placed[j], positions);
            const Quat outer_rotation =
                parent < 0 ? Quat(1, 0, 0, 0)
                           : outer.turn * rest_rotations_[static_cast<std::size_t>(parent)];
            Quat local = glm::normalize(
                glm::conjugate(outer_rotation) * placed[j].turn * rest_rotations_[j]);
            if (frames.rotations.size() >= frames.joints) {
                local = to_same_hemisphere(
                    frames.rotations[frames.rotations.size() - frames.joints], local);
            }
            frames.rotations.push_back(local);
            frames.translations.push_back(
                is_top_[j] ? local_position(j, outer, placed[j]) : skeleton_.rest.translations[j]);
            frames.scales.push_back(skeleton_.rest.scales[j]);
        }
    }

    [[nodiscard]] float residual() const {
        return count_ > 0 ? static_cast<float>(std::sqrt(squares_ / static_cast<double>(count_)))
                          : 0.0f;
    }

  private:
    [[nodiscard]] Vec3 rest_position(std::size_t joint) const {
        return transform_point(rest_[joint], Vec3(0));
    }

    Placement
    place_joint(std::size_t joint, const Placement& outer, std::span<const Vec3> positions) const {
        std::vector<Vec3> from;
        std::vector<Vec3> to;
        for (const std::size_t m : of_joint_[joint]) {
            if (is_finite(positions[m])) {
                from.push_back(markers_[m].position);
                to.push_back(positions[m]);
            }
        }
        if (from.empty()) {
            return outer;
        }
        const Vec3 pivot = rest_position(joint);
        const Result<Affine> fitted = fit_rigid(from, to);
        Placement placement = outer;
        if (fitted) {
            const Affine& a = *fitted;
            placement.turn =
                extract_rotation(
                    glm::transpose(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2]))))
                    .value_or(outer.turn);
            placement.shift = transform_point(a, pivot) - placement.turn * pivot;
        } else {
            placement = aim(joint, outer, from, to);
        }
        if (!is_top_[joint]) {  // bones keep their lengths
            placement.shift = outer.place(pivot) - placement.turn * pivot;
        }
        return placement;
    }

    /// With too few markers for a fit: turned with the parent, then towards the mean of its
    /// markers.
    Placement
    aim(std::size_t joint, const Placement& outer, std::span<const Vec3> from,
        std::span<const Vec3> to) const {
        Vec3 mean_from(0);
        Vec3 mean_to(0);
        for (std::size_t i = 0; i < from.size(); ++i) {
            mean_from += from[i] / static_cast<float>(from.size());
            mean_to += to[i] / static_cast<float>(from.size());
        }
        Placement placement = outer;
        if (is_top_[joint]) {
            placement.shift = mean_to - outer.turn * mean_from;
            return placement;
        }
        const Vec3 pivot = outer.place(rest_position(joint));
        const Vec3 before = normalize_or(outer.place(mean_from) - pivot, Vec3(0));
        const Vec3 after = normalize_or(mean_to - pivot, Vec3(0));
        if (before != Vec3(0) && after != Vec3(0)) {
            placement.turn = glm::normalize(shortest_arc(before, after) * outer.turn);
        }
        return placement;
    }

    /// The joint's translation in the space of its parent.
    [[nodiscard]] Vec3
    local_position(std::size_t joint, const Placement& outer, const Placement& placement) const {
        const Vec3 moved = placement.place(rest_position(joint));
        const std::int32_t parent = skeleton_.parents[joint];
        if (parent < 0) {
            return moved;
        }
        const Vec3 at_rest = glm::conjugate(outer.turn) * (moved - outer.shift);
        return transform_point(
            to_affine(glm::inverse(to_mat4(rest_[static_cast<std::size_t>(parent)]))), at_rest);
    }

    void measure(std::size_t joint, const Placement& placement, std::span<const Vec3> positions) {
        for (const std::size_t m : of_joint_[joint]) {
            if (is_finite(positions[m])) {
                const Vec3 off = placement.place(markers_[m].position) - positions[m];
                squares_ += static_cast<double>(glm::dot(off, off));
                ++count_;
            }
        }
    }

    const SkeletonData& skeleton_;
    std::vector<Affine> rest_;
    std::vector<Quat> rest_rotations_;
    std::span<const BodyMarker> markers_;
    std::vector<std::vector<std::size_t>> of_joint_;  ///< markers of each joint
    std::vector<bool> is_top_;  ///< joints with markers and without an ancestor with any
    double squares_ = 0;
    std::size_t count_ = 0;
};

}  // namespace

Result<MarkerFit> fit_markers(
    const SkeletonData& skeleton, std::span<const BodyMarker> markers, const MarkerMotion& take) {
    LIMN_CHECK(markers.size() == take.markers());
    MarkerFitter fitter(skeleton, markers);
    if (!fitter.has_markers()) {
        return fail("found no marker of a joint, expected at least one");
    }
    MarkerFit fit;
    fit.frames.rate = take.rate;
    fit.frames.joints = skeleton.joints.size();
    for (std::size_t f = 0; f < take.frames(); ++f) {
        fitter.fit(
            std::span(take.positions).subspan(f * take.markers(), take.markers()), fit.frames);
    }
    fit.residual = fitter.residual();
    return fit;
}

}  // namespace limn
