#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace limn {
class World;
}

namespace limn::oracle {

// Shadows by ray casting in double precision, the reference for shadow maps and volumes. A bounding
// volume hierarchy holds every triangle of the world's casters; a ray is blocked by either side of
// a triangle, except in the holes of an alpha-tested surface.

using DVec3 = glm::dvec3;

/// The occluders of a world at the time of construction.
class ShadowScene {
  public:
    /// Opaque and alpha-tested mesh instances of `world` without NoShadow, at their WorldTransform.
    explicit ShadowScene(const World& world);

    /// Whether anything lies between the two points. Hits closer than `skin` [m] to either end are
    /// ignored, such as the surface that the ray leaves.
    [[nodiscard]] bool blocked(const DVec3& from, const DVec3& to, double skin = 1e-4) const;
    /// The same for a directional light, in the direction `to_light` (unit).
    [[nodiscard]] bool blocked_toward(const DVec3& from, const DVec3& to_light) const;

    /// Visible fraction of a disc of `diameter` about `center`, facing `from` (shadow.penumbra):
    /// the mean of side^2 rays.
    [[nodiscard]] double
    visible_fraction(const DVec3& from, const DVec3& center, double diameter, int side = 16) const;

    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }

  private:
    struct Triangle {
        DVec3 corner;
        DVec3 edge_u;
        DVec3 edge_v;
        glm::dvec2 uv[3];
        std::int32_t mask = -1;  ///< index into masks_; -1: no holes
    };
    /// Opacity of an alpha-tested material over its texture.
    struct Mask {
        int width = 0;
        int height = 0;
        std::vector<double> opacity;
        double cutoff = 0.5;
    };
    struct Node {
        DVec3 min;
        DVec3 max;
        std::uint32_t first = 0;  ///< first triangle of a leaf; else second child
        std::uint32_t count = 0;  ///< triangles of a leaf; 0: inner node, first child is next
    };

    void build(std::uint32_t begin, std::uint32_t end);
    [[nodiscard]] bool hits(const DVec3& from, const DVec3& along, double begin, double end) const;
    [[nodiscard]] bool has_hole(const Triangle& triangle, double u, double v) const;

    std::vector<Triangle> triangles_;
    std::vector<Mask> masks_;
    std::vector<Node> nodes_;
};

/// shadow.penumbra: width of the penumbra of an edge at distance `blocker` from a source of
/// `width`, on a receiver at distance `receiver` from the source.
[[nodiscard]] double penumbra_width(double width, double blocker, double receiver);

}  // namespace limn::oracle
