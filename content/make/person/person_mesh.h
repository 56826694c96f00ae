#pragma once

#include "content/make/person/person_skeleton.h"
#include "ecs/components/surface.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Closed shells of quads for a person: tubes of rings, tubes that leave a hole in others, caps. The
// left half is modelled; the right one is its mirror image, welded where x = 0. All in meters at
// the reference height.

/// What a vertex belongs to: which joints may move it (person_weights).
enum class BodyZone : std::uint8_t {
    Trunk,   ///< chest to thighs
    Skirt,   ///< the same, but thighs move it less
    Leg,     ///< down to the ankle
    Calf,    ///< the same, with the foot
    Arm,     ///< `along` it from the shoulder
    Palm,    ///< likewise, the wrist is at the length of the arm
    Finger,  ///< `along` it from its first joint; `finger` 0: thumb .. 4: little
    Shoe,
    Head,  ///< by height: down the neck to the chest
    Eye,
};

struct BodyVertex {
    Vec3 position = {};
    Vec3 color = {1, 1, 1};  ///< linear
    BodyZone zone = BodyZone::Trunk;
    std::int8_t finger = 0;
    std::int8_t side = 1;  ///< -1: on the right
    bool fair = false;     ///< smoothed by fair()
    float along = 0;       ///< [m]
    Vec3 lift = {};        ///< where folds move it, a unit vector; 0: along the normal
};

struct BodyQuad {
    std::array<std::uint32_t, 4> corners = {};  ///< the last two are equal: a triangle
    std::array<Vec2, 4> uvs = {};
};

/// Vertices around a tube, or half of one that begins and ends at x = 0.
struct BodyRing {
    std::vector<std::uint32_t> vertices;
    bool closed = true;
    float v = 0;  ///< texture coordinate along the tube
};

class BodyMesh {
  public:
    std::uint32_t add(const BodyVertex& vertex);
    void add_quad(const std::array<std::uint32_t, 4>& corners, const std::array<Vec2, 4>& uvs);

    /// Quads between two rings of the same size. `width`: of a column in texture space; `first`:
    /// the column where u = 0.
    void join(const BodyRing& a, const BodyRing& b, float width, float first = 0);

    /// Closes a ring by a fan around its center, moved by `offset`. `turned`: seen from the side
    /// that the ring ends at, as its last ring; else as its first.
    std::uint32_t cap(const BodyRing& ring, const Vec3& offset, float width, bool turned);

    /// Moves vertices that are `fair` toward the mean of their neighbors.
    void fair(int rounds);

    /// Adds the mirror images of all vertices and quads; vertices at x = 0 are their own.
    void mirror();

    /// Turns each connected shell so that it faces outwards.
    void face_outwards();

    /// Triangles with normals (smooth up to `crease` [rad]), tangents, colors and skin weights.
    [[nodiscard]] MeshData finish(const PersonFrame& frame, float crease) const;

    std::vector<BodyVertex> vertices;
    std::vector<BodyQuad> quads;
};

/// Collapses edges where neither shape nor skin weights nor colors vary, up to an error of `error`
/// at the reference height [m]. Vertices that are left keep all but their normals, which are smooth
/// up to `crease` [rad]. Levels of detail (PersonShape::triangles) are left as they are: seams of
/// new normals would hinder simplify_mesh.
void thin_out(MeshData& mesh, const PersonFrame& frame, float error, float crease);

/// Appends `part`, which has the same vertex arrays, to `mesh`. Morph targets of `part`, if it has
/// any, are the same list.
void append_part(MeshData& mesh, const MeshData& part);

}  // namespace limn
