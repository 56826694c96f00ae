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
                                     ///< not visible

    [[nodiscard]] std::size_t markers() const { return names.size(); }
    [[nodiscard]] std::size_t frames() const {
        return names.empty() ? 0 : positions.size() / names.size();
    }
};

/// The rotation and translation that maps `from` to `to` with the least sum of squared distances,
/// never a reflection: B. Horn, "Closed-form solution of absolute orientation using unit
/// quaternions", 1987. Fails with one line when there are fewer than three points, they are
/// collinear, or some are not finite.
[[nodiscard]] Result<Affine> fit_rigid(std::span<const Vec3> from, std::span<const Vec3> to);

/// Fills in missing positions (face.mocap-drive). A hidden marker moves like its neighbors, the
/// visible markers that are nearest to it at rest; its offset from them is interpolated linearly
/// between the frames where it was last and is next visible. A marker that is never visible moves
/// like its neighbors around `rest`.
void fill_gaps(MarkerMotion& motion, std::span<const Vec3> rest);

/// Positions at `time` [s], linear between frames, constant before the first and after the last.
/// At least one frame.
[[nodiscard]] std::vector<Vec3> sample_markers(const MarkerMotion& motion, float time);

/// Removes the motion of the head (face.head-stabilise): moves the markers of each frame rigidly so
/// that those on the head, `head`, best fit their positions at rest. In frames where fewer than
/// three of them are visible, or those lie in a line, the head moves evenly from the last pose that
/// is known to the next. Returns the transform of the head in each frame. Fails as fit_rigid does
/// at rest, or when there is no frame with three.
[[nodiscard]] Result<std::vector<Affine>> stabilize_head(
    MarkerMotion& motion, std::span<const Vec3> rest, std::span<const std::uint32_t> head);

}  // namespace limn
