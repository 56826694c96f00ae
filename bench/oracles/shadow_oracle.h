#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace limn {
class World;
}

namespace limn::oracle {

// Shadows by casting rays, in double precision: what shadow maps and volumes are held against.
// Every triangle of the world's casters is in a tree of boxes; a ray is blocked if it meets one of
// them, whichever side it shows, and not where an alpha-tested surface has a hole.

using DVec3 = glm::dvec3;

/// What can block light. A picture of the moment it was made at.
class ShadowScene {
  public:
    /// Opaque and alpha-tested mesh instances of `world` without NoShadow, at their WorldTransform.
    explicit ShadowScene(const World& world);

    /// Whether something lies between the two points. What is nearer than `skin` [m] to either end
    /// does not count: the surface that the ray leaves.
    [[nodiscard]] bool blocked(const DVec3& from, const DVec3& to, double skin = 1e-4) const;
    /// The same for a light without a place, in the direction `to_light` (unit).
    [[nodiscard]] bool blocked_toward(const DVec3& from, const DVec3& to_light) const;

    /// Share of a disc of `diameter` about `middle`, facing `from`, that is seen (shadow.penumbra):
    /// the mean of side^2 rays.
    [[nodiscard]] double
    seen_share(const DVec3& from, const DVec3& middle, double diameter, int side = 16) const;

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
        std::uint32_t first = 0;  ///< triangle of a leaf; else index of the second child
        std::uint32_t count = 0;  ///< of triangles; 0: the first child is the next node
    };

    void build(std::uint32_t begin, std::uint32_t end);
    [[nodiscard]] bool meets(const DVec3& from, const DVec3& along, double begin, double end) const;
    [[nodiscard]] bool has_hole(const Triangle& triangle, double u, double v) const;

    std::vector<Triangle> triangles_;
    std::vector<Mask> masks_;
    std::vector<Node> nodes_;
};

/// shadow.penumbra: width of the penumbra of an edge `blocker` away from a source of `width`, on a
/// receiver `receiver` away.
[[nodiscard]] double penumbra_width(double width, double blocker, double receiver);

}  // namespace limn::oracle
