#pragma once

#include "ecs/base/math.h"
#include "ecs/components/camera.h"
#include "ecs/entity.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace limn {
class World;
}

namespace limn::oracle {

// Screen-space velocity by ray casting in double precision: the triangle hit, the previous position
// of that point of the triangle, and the motion of its projection. Shares no matrix with the
// renderer.

/// A camera interpolated between two steps, like make_render_view's.
struct CameraMotion {
    Camera camera;
    Affine previous;
    Affine current;
    int width = 0;   ///< [px]
    int height = 0;  ///< [px]
    double alpha = 1;
    double previous_alpha = 0;
};

struct PixelMotion {
    double distance = 0;  ///< along the view axis [m]
    glm::dvec2 velocity;  ///< [px], right and down
};

/// World positions of the vertices of a mesh instance, deformed or not, at interpolation factor
/// `alpha`.
[[nodiscard]] std::vector<glm::dvec3> corners_at(const World& world, Entity entity, double alpha);

class VelocityOracle {
  public:
    explicit VelocityOracle(const CameraMotion& motion);

    /// Adds all mesh instances of the world; Pose and MorphWeights need valid `previous` values.
    void add(const World& world);
    /// Motion of the nearest triangle, front or back, at a point of the image [px from the top
    /// left]; none without a hit.
    [[nodiscard]] std::optional<PixelMotion> at(double x, double y) const;
    /// Motion of the background at infinity.
    [[nodiscard]] glm::dvec2 sky(double x, double y) const;

  private:
    struct Eye {
        glm::dvec3 position, right, up, back;
    };
    [[nodiscard]] Eye eye_at(double alpha) const;
    [[nodiscard]] glm::dvec3 ray(const Eye& eye, double x, double y) const;
    /// Projection of a vector from the eye [px].
    [[nodiscard]] glm::dvec2 project(const Eye& eye, const glm::dvec3& direction) const;

    CameraMotion motion_;
    Eye eye_;
    Eye previous_eye_;
    std::vector<glm::dvec3> corners_;  // three per triangle
    std::vector<glm::dvec3> previous_corners_;
};

}  // namespace limn::oracle
