#include "content/make/models/boat.h"

#include "content/make/models/surface_grid.h"
#include "content/models/boat_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr float kDifference = 1e-3f;  // step in u and v for normals

/// A patch of the surface place(u, v); seen from the front, u runs to the right and v downwards.
template <typename Place, typename Paint>
void add_patch(
    MeshData& mesh, int columns, int rows, const Vec2& uv_scale, Place&& place, Paint&& paint) {
    append_grid(mesh, columns, rows, {}, [&](int i, int j) {
        const float u = part(i, columns);
        const float v = part(j, rows);
        const float d = kDifference;
        const float inside = std::clamp(v, 0.02f, 0.98f);  // not at the tip of a cone
        const Vec3 along = place(u + d, inside) - place(u - d, inside);
        const Vec3 down = place(u, v + d) - place(u, v - d);
        GridVertex vertex;
        vertex.position = place(u, v);
        vertex.normal = normalize_or(glm::cross(down, along), Vec3(0, 1, 0));
        const Vec3 flat = along - glm::dot(along, vertex.normal) * vertex.normal;
        const Vec3 aside = std::abs(vertex.normal.x) < 0.9f ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
        vertex.tangent = normalize_or(flat, glm::normalize(glm::cross(vertex.normal, aside)));
        vertex.uv = {u * uv_scale.x, v * uv_scale.y};
        mesh.colors.push_back(paint(vertex.position));
        return vertex;
    });
}

template <typename Place>
void add_patch(MeshData& mesh, int columns, int rows, const Vec2& uv, Place&& place, Vec4 color) {
    add_patch(mesh, columns, rows, uv, place, [&](const Vec3&) { return color; });
}

/// A tube from `a` to `b`, capped at both ends by cones as long as its radius.
void add_spar(MeshData& mesh, const boat::Spar& spar) {
    const auto& [a, b, radius_a, radius_b, color] = spar;
    const Vec3 axis = glm::normalize(b - a);
    const Vec3 side =
        glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9f ? Vec3(0, 1, 0) : Vec3(0, 0, 1)));
    const Vec3 front = glm::cross(axis, side);
    const auto around = [=](float u) {
        return std::cos(2 * kPi * u) * side + std::sin(2 * kPi * u) * front;
    };
    const auto tube = [&](float u, float v) {
        return glm::mix(spar.b, spar.a, v) + glm::mix(spar.radius_b, spar.radius_a, v) * around(u);
    };
    add_patch(mesh, 10, 1, {1, glm::distance(a, b)}, tube, color);
    for (const bool far : {true, false}) {
        const Vec3 end = far ? b : a;
        const Vec3 tip = end + (far ? radius_b : -radius_a) * axis;
        const auto cone = [&](float u, float v) {
            const float r = far ? spar.radius_b * v : spar.radius_a * (1 - v);
            return glm::mix(far ? tip : end, far ? end : tip, v) + r * around(u);
        };
        add_patch(mesh, 10, 1, {1, 0.1f}, cone, color);
    }
}

// ---- the hull -----------------------------------------------------------------------------------

/// t from astern (0) to the bow (1).
float sheer_height(float t) {
    return 0.52f + 0.42f * square(std::max(t - 0.35f, 0.0f)) / square(0.65f)
           + 0.10f * square(std::max(0.35f - t, 0.0f)) / square(0.35f);
}

float keel_height(float t) {
    const float fore = glm::smoothstep(0.72f, 1.05f, t);
    const float aft = glm::smoothstep(0.0f, 0.55f, t);
    return boat::kKeel * (0.25f + 0.75f * aft) * (1 - 0.55f * fore);
}

float half_breadth(float t) {
    return t > 0.42f
               ? boat::kHalfBeam * (1 - std::pow(std::clamp((t - 0.42f) / 0.58f, 0.0f, 1.0f), 2.3f))
               : boat::kHalfBeam * (1 - 0.32f * square((0.42f - t) / 0.42f));
}

/// The port side: s from the keel (0) to the sheer (1).
Vec3 side_place(float t, float s) {
    const float angle = std::clamp(s, 0.0f, 1.0f) * 0.5f * kPi;
    const float fore = glm::smoothstep(0.55f, 1.0f, t);
    const float out = std::pow(std::sin(angle), glm::mix(0.72f, 1.35f, fore));
    const float up = 1 - std::pow(std::max(std::cos(angle), 0.0f), glm::mix(1.5f, 1.0f, fore));
    Vec3 p;
    p.x = half_breadth(t) * out;
    p.y = glm::mix(keel_height(t), sheer_height(t), up);
    // The stem rakes ahead, the transom aft.
    p.z = (t - 0.5f) * boat::kLength - 0.75f * (1 - up) * std::pow(std::max(t, 0.0f), 7.0f)
          - 0.22f * up * std::pow(std::max(1 - t, 0.0f), 5.0f);
    return p;
}

Vec3 side_normal(float t, float s) {
    const float d = 0.01f;
    const Vec3 along = side_place(std::min(t + d, 1.0f), s) - side_place(std::max(t - d, 0.0f), s);
    const Vec3 up = side_place(t, std::min(s + d, 1.0f)) - side_place(t, std::max(s - d, 0.0f));
    return normalize_or(glm::cross(up, along), Vec3(1, 0, 0));
}

Vec4 hull_paint(const Vec3& p) {
    return p.y < 0.02f ? boat::kBottom : boat::kPaint;
}

void add_hull_side(MeshData& mesh, const BoatShape& shape, float side) {
    const auto mirrored = [side](const Vec3& p) { return Vec3(side * p.x, p.y, p.z); };
    for (int k = 0; k < shape.strakes; ++k) {
        const float low = part(k, shape.strakes);
        const float high = part(k + 1, shape.strakes);
        // Seen from outside, the bow is to the left on the port side, to the right on the other.
        const auto plank = [&](float u, float v) {
            const float t = std::clamp(side > 0 ? 1 - u : u, 0.0f, 1.0f);
            const float s = glm::mix(high, low, v);
            return mirrored(side_place(t, s) + boat::kLap * v * side_normal(t, s));
        };
        add_patch(mesh, shape.stations, 1, {boat::kLength, 0.25f}, plank, [&](const Vec3& p) {
            return p.y < 0.03f ? boat::kBottom : boat::kPaint;
        });
        const auto edge = [&](float u, float v) {
            const float t = std::clamp(side > 0 ? 1 - u : u, 0.0f, 1.0f);
            return mirrored(side_place(t, low) + boat::kLap * (1 - v) * side_normal(t, low));
        };
        add_patch(mesh, shape.stations, 1, {boat::kLength, 0.01f}, edge, boat::kShade);
    }
    // The rail, a tube along the sheer.
    const auto rail = [&](float u, float v) {
        const float t = std::clamp(u, 0.0f, 1.0f);
        const float angle = 2 * kPi * (side > 0 ? v : 1 - v);
        return mirrored(side_place(t, 1) + boat::kRail * Vec3(std::cos(angle), std::sin(angle), 0));
    };
    add_patch(mesh, shape.stations, 8, {boat::kLength, 0.2f}, rail, boat::kTrim);
}

MeshData make_hull(const BoatShape& shape) {
    MeshData mesh;
    add_hull_side(mesh, shape, 1);
    add_hull_side(mesh, shape, -1);
    const auto transom = [](float u, float v) {  // seen from astern, port is to the left
        const Vec3 edge = side_place(0, 1 - std::clamp(v, 0.0f, 1.0f));
        return Vec3((1 - 2 * u) * edge.x, edge.y, edge.z);
    };
    add_patch(mesh, 8, 8, {1.4f, 0.6f}, transom, hull_paint);
    // Stem and keel: a protruding plank from the transom to the rail at the bow.
    for (const float side : {1.0f, -1.0f}) {
        const auto keel = [&](float u, float v) {
            const float along = std::clamp(side > 0 ? 1 - u : u, 0.0f, 1.0f);
            const float t = std::min(along / 0.8f, 1.0f);
            const float s = along > 0.8f ? (along - 0.8f) / 0.2f : 0.0f;
            const Vec3 p = side_place(t, s);
            const Vec3 out = normalize_or(
                Vec3(0, -1 + s, 0.9f * glm::smoothstep(0.7f, 1.0f, along)), {0, -1, 0});
            return Vec3(side * 0.03f, p.y, p.z) + out * (0.09f * v - 0.02f);
        };
        add_patch(mesh, 2 * shape.stations, 1, {boat::kLength, 0.1f}, keel, [](const Vec3& p) {
            return p.y < 0.03f ? boat::kBottom : boat::kTrim;
        });
    }
    // The fin below, the rudder behind it and the tiller.
    for (const float side : {1.0f, -1.0f}) {
        for (const boat::Blade& blade : boat::kBlades) {
            const auto surface = [&](float u, float v) {
                const float along = side > 0 ? 1 - u : u;  // 0 aft, 1 ahead
                const float z = glm::mix(
                    glm::mix(blade.aft.x, blade.fore.x, along),
                    glm::mix(blade.aft.y, blade.fore.y, along), v);
                const float profile = std::sqrt(std::clamp(along * (1 - along), 0.0f, 0.25f));
                return Vec3(
                    side * blade.thickness * (1.2f - 0.8f * along) * profile,
                    glm::mix(blade.top, blade.bottom, v), z);
            };
            add_patch(mesh, blade.quads.x, blade.quads.y, blade.uv, surface, [](const Vec3& p) {
                return p.y < 0.02f ? boat::kBottom : boat::kTrim;
            });
        }
    }
    add_spar(mesh, boat::kTiller);
    return mesh;
}

// ---- the deck -----------------------------------------------------------------------------------

/// Point of the deck at t, `across` = -1 .. 1 half-breadths: slightly below the rail, cambered.
Vec3 deck_place(float t, float across) {
    const Vec3 edge = side_place(std::clamp(t, 0.0f, 1.0f), 1);
    return {across * edge.x, edge.y - 0.015f + 0.06f * edge.x * (1 - across * across), edge.z};
}

MeshData make_deck(const BoatShape& shape) {
    MeshData mesh;
    const int n = shape.stations;
    // Seen from above with the bow up, +x is to the left.
    for (const boat::DeckStrip& strip : boat::kDeck) {
        const auto place = [&](float u, float v) {
            return deck_place(
                glm::mix(strip.end, strip.begin, v), glm::mix(strip.left, strip.right, u));
        };
        const float share = strip.end - strip.begin;
        const int rows = std::max(2, static_cast<int>(static_cast<float>(n) * share));
        const Vec2 uv = {std::abs(strip.left - strip.right), share * boat::kLength};
        add_patch(mesh, strip.columns, rows, uv, place, boat::kPaint);
    }

    // The coaming, an upright board around the well, and the walls of the well below it.
    const auto rim = [](float t, float side, float height) {
        const Vec3 p = deck_place(t, side * boat::kWell);
        return Vec3(p.x, height < 0 ? boat::kSole : p.y + height, p.z);
    };
    for (const float side : {1.0f, -1.0f}) {
        const auto t_at = [side](float u) {
            return glm::mix(boat::kWellBegin, boat::kWellEnd, side > 0 ? u : 1 - u);
        };
        const auto inside = [&](float u, float v) {
            return glm::mix(rim(t_at(u), side, 0.09f), rim(t_at(u), side, -1), v);
        };
        const auto outside = [&](float u, float v) {
            return glm::mix(rim(t_at(1 - u), side, 0.09f), rim(t_at(1 - u), side, -0.0f), v)
                   + Vec3(side * 0.025f, 0, 0);
        };
        const auto top = [&](float u, float v) {
            return rim(t_at(u), side, 0.09f) + Vec3(side * 0.025f * (1 - v), 0, 0);
        };
        add_patch(mesh, 12, 1, {3, 0.5f}, inside, boat::kPaint);
        add_patch(mesh, 12, 1, {3, 0.1f}, outside, boat::kTrim);
        add_patch(mesh, 12, 1, {3, 0.03f}, top, boat::kTrim);
        // bench
        const auto bench = [&](float u, float v) {
            Vec3 p = rim(t_at(u), side, -1);
            p.y = 0.30f;
            p.x -= side * 0.34f * v;
            return p;
        };
        add_patch(mesh, 8, 1, {3, 0.34f}, bench, boat::kPaint);
        const auto front = [&](float u, float v) {
            Vec3 p = rim(t_at(u), side, -1);
            p.y = glm::mix(0.30f, boat::kSole, v);
            p.x -= side * 0.34f;
            return p;
        };
        add_patch(mesh, 8, 1, {3, 0.25f}, front, boat::kShade);
    }
    for (const float t : {boat::kWellBegin, boat::kWellEnd}) {
        const float way = t == boat::kWellEnd ? 1.0f : -1.0f;
        const auto wall = [&](float u, float v) {
            const float across = way * glm::mix(1.0f, -1.0f, u) * boat::kWell;
            const Vec3 p = deck_place(t, across);
            return Vec3(p.x, glm::mix(p.y + 0.09f, boat::kSole, v), p.z);
        };
        add_patch(mesh, 4, 1, {1.3f, 0.5f}, wall, boat::kPaint);
        const auto back = [&](float u, float v) {
            const float across = -way * glm::mix(1.0f, -1.0f, u) * boat::kWell;
            const Vec3 p = deck_place(t, across);
            return Vec3(p.x, p.y + 0.09f * (1 - v), p.z + way * 0.02f);
        };
        add_patch(mesh, 4, 1, {1.3f, 0.1f}, back, boat::kTrim);
    }
    const auto sole = [&](float u, float v) {
        const float t = glm::mix(boat::kWellEnd, boat::kWellBegin, v);
        return glm::mix(rim(t, 1, -1), rim(t, -1, -1), u);
    };
    add_patch(mesh, 2, 8, {1.2f, 3}, sole, boat::kShade);
    return mesh;
}

// ---- spars and rig ------------------------------------------------------------------------------

MeshData make_spars() {
    MeshData mesh;
    for (const boat::Spar& spar : boat::kMast) {
        add_spar(mesh, spar);
    }
    return mesh;
}

/// Point of the sail: u from luff to leech, v from head to foot.
Vec3 sail_place(float u, float v) {
    const Vec2 head = glm::mix(Vec2(-0.07f, boat::kThroat), boat::kPeak, u);
    const Vec2 foot = glm::mix(
        Vec2(-0.07f, boat::kBoomHeight + 0.1f),
        Vec2(-boat::kBoomLength + 0.2f, boat::kBoomHeight + 0.22f), u);
    const Vec2 flat = glm::mix(head, foot, v);
    const float chord = glm::mix(3.0f, boat::kBoomLength, v);
    const float along = std::clamp(u, 0.0f, 1.0f);
    // Deepest at two fifths of the chord; boom and gaff hold it flat.
    const float arc = 6.75f * 0.6f * along * square(1 - along) + 1.2f * along * (1 - along);
    const float down = std::clamp(v, 0.0f, 1.0f);
    const float held = 1 - square(1 - 4 * down * (1 - down));
    const float roach = 0.10f * 4 * down * (1 - down) * along;
    return {
        boat::kBelly * chord * arc * held * 0.85f + 0.12f * along * std::sin(kPi * (1 - down)),
        flat.y, flat.x - roach};
}

MeshData make_rig() {
    MeshData mesh;
    for (const float side : {1.0f, -1.0f}) {
        // Seen from port (+x), u runs to the right, toward the stern.
        const auto cloth = [side](float u, float v) {
            const float along = side > 0 ? u : 1 - u;
            return sail_place(along, v) + Vec3(side * boat::kSailGap, 0, 0);
        };
        add_patch(mesh, 14, 14, {1, 7}, cloth, boat::kPaint);
    }
    for (const boat::Spar& spar : boat::kBoomAndGaff) {
        add_spar(mesh, spar);
    }
    return mesh;
}

}  // namespace

Vec3 mast_position(float length) {
    return {0, 0, boat::kMastFoot * length / boat::kLength};
}

MeshData make_boat(const BoatShape& shape) {
    MeshData mesh;
    switch (shape.part) {
    case BoatPart::Hull:
        mesh = make_hull(shape);
        break;
    case BoatPart::Deck:
        mesh = make_deck(shape);
        break;
    case BoatPart::Spars:
        mesh = make_spars();
        break;
    case BoatPart::Rig:
        mesh = make_rig();
        break;
    }
    mesh.bounds = {};
    for (Vec3& p : mesh.positions) {
        p *= shape.length / boat::kLength;
        grow(mesh.bounds, p);
    }
    return mesh;
}

}  // namespace limn
