#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Motion of markers on a face, as recorded: positions of all markers in each frame, some missing.

struct MarkerMotion {
    std::vector<std::string> names;  ///< one per marker
    float rate = 60.0f;              ///< frames per second, > 0
    std::vector<Vec3> positions;     ///< of marker m in frame f at f * names.size() + m [m]; NaN:
                                     ///< not seen

    [[nodiscard]] std::size_t markers() const { return names.size(); }
    [[nodiscard]] std::size_t frames() const {
        return names.empty() ? 0 : positions.size() / names.size();
    }
};

/// The rotation and translation that takes `from` to `to` with the least sum of squared distances,
/// never a reflection: B. Horn, "Closed-form solution of absolute orientation using unit
/// quaternions", 1987. Fails with one line when there are fewer than three points, they lie in a
/// line, or some are not finite.
[[nodiscard]] Result<Affine> fit_rigid(std::span<const Vec3> from, std::span<const Vec3> to);

/// Replaces missing positions (face.mocap-drive). A marker moves like its neighbors, the markers
/// that are nearest to it at rest and seen, while it is hidden; what it differed by when it
/// was last seen becomes what it differs by when seen next, linearly. One that is never seen moves
/// like its neighbors around `rest`.
void fill_gaps(MarkerMotion& motion, std::span<const Vec3> rest);

/// Positions at `time` [s], linear between frames, held before the first and after the last.
/// At least one frame.
[[nodiscard]] std::vector<Vec3> sample_markers(const MarkerMotion& motion, float time);

/// Takes the motion of the head out (face.head-stabilise): moves the markers of each frame so that
/// those on the head, `head`, fit their places at rest as well as a rigid motion can. Returns where
/// the head was in each frame. Fails as fit_rigid does, with the number of the frame.
[[nodiscard]] Result<std::vector<Affine>> stabilize_head(
    MarkerMotion& motion, std::span<const Vec3> rest, std::span<const std::uint32_t> head);

}  // namespace limn
