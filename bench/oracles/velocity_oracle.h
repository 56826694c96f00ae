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

// The motion of what a pixel shows, by casting a ray in double precision: the triangle it meets,
// where that point of the triangle was the moment before, and how far its projection has come. It
// shares no matrix with the renderer.

/// A camera between two steps, as make_render_view has it.
struct CameraMotion {
    Camera camera;
    Affine previous;
    Affine current;
    int width = 0;   ///< [px]
    int height = 0;  ///< [px]
    double alpha = 1;
    double alpha_before = 0;
};

struct PixelMotion {
    double distance = 0;  ///< along the view axis [m]
    glm::dvec2 velocity;  ///< [px], right and down
};

/// World positions of the vertices of a mesh instance, deformed or not, at the moment `alpha`.
[[nodiscard]] std::vector<glm::dvec3> corners_at(const World& world, Entity entity, double alpha);

class VelocityOracle {
  public:
    explicit VelocityOracle(const CameraMotion& motion);

    /// Adds all that is drawn of the world; Pose and MorphWeights must have their `previous`.
    void add(const World& world);
    /// Of the nearest triangle, front or back, at a point of the picture, from the top left [px];
    /// none where nothing is.
    [[nodiscard]] std::optional<PixelMotion> at(double x, double y) const;
    /// Of what is infinitely far away.
    [[nodiscard]] glm::dvec2 sky(double x, double y) const;

  private:
    struct Eye {
        glm::dvec3 place, right, up, back;
    };
    [[nodiscard]] Eye eye_at(double alpha) const;
    [[nodiscard]] glm::dvec3 ray(const Eye& eye, double x, double y) const;
    /// Of a way from the eye [px].
    [[nodiscard]] glm::dvec2 project(const Eye& eye, const glm::dvec3& way) const;

    CameraMotion motion_;
    Eye now_;
    Eye before_;
    std::vector<glm::dvec3> corners_now_;  // three a triangle
    std::vector<glm::dvec3> corners_before_;
};

}  // namespace limn::oracle
