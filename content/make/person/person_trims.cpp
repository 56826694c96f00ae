// What is sewn onto clothes: closed shells that lie on them.

#include "content/make/person/person_cloth.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace limn {

namespace {

constexpr float kTrimColumn = 0.004f;   ///< in texture space [m]
constexpr float kLeafColumn = 0.012f;   ///< likewise, around a collar
constexpr int kCollarTriangles = 3000;  ///< with fewer in all, there are no collars
constexpr int kTrimTriangles = 7000;    ///< likewise, neither plackets, buttons nor pockets

bool shows(const PersonFrame& frame, int triangles) {
    const int all = frame.look.shape.triangles;
    return all == 0 || all >= triangles;
}

/// Where the shirt is `x` beside its middle in front.
float angle_beside(const PersonFrame& frame, float height, float x) {
    const float width = shirt_point(frame, height, 0.5f * kPi, 0).x;
    return std::asin(std::pow(std::min(x / width, 1.0f), 1.15f));
}

BodyVertex trim_vertex(const Vec3& position, const Vec3& color) {
    BodyVertex vertex;
    vertex.position = position;
    vertex.color = color;
    vertex.lift = normalize_or(Vec3(position.x, 0, position.z + 0.01f), Vec3(0, 0, 1));
    return vertex;
}

/// A point of the cloth: across the patch 0 .. 1, along it 0 .. 1, outside of the cloth [m].
using PatchPoint = std::function<Vec3(float across, float along, float grow)>;

struct Patch {
    int columns = 1;
    int rows = 1;
    bool middle = false;  ///< begins at x = 0, where its mirror image continues it
    float thick = 0.002f;
    Vec2 size = {0.03f, 0.06f};  ///< across and along, in texture space [m]
    Vec3 color = {};
};

/// A flat closed shell.
void add_patch(BodyMesh& mesh, const Patch& patch, const PatchPoint& point) {
    constexpr float kBelow = -0.004f;
    const float width = patch.size.x / static_cast<float>(patch.columns);
    BodyRing last;
    for (int r = 0; r <= patch.rows; ++r) {
        const float along = static_cast<float>(r) / static_cast<float>(patch.rows);
        BodyRing ring;
        ring.closed = !patch.middle;
        ring.v = patch.size.y * along;
        for (const bool outside : {true, false}) {
            for (int c = 0; c <= patch.columns; ++c) {
                const int column = outside ? c : patch.columns - c;
                const float across = static_cast<float>(column) / static_cast<float>(patch.columns);
                Vec3 p = point(across, along, outside ? patch.thick : kBelow);
                p.x = patch.middle && column == 0 ? 0.0f : p.x;
                ring.vertices.push_back(mesh.add(trim_vertex(p, patch.color)));
            }
        }
        if (r == 0) {
            mesh.cap(ring, Vec3(0), width, false);
        } else {
            mesh.join(last, ring, width);
        }
        last = ring;
    }
    mesh.cap(last, Vec3(0), width, true);
}

/// The half of a disc on the middle in front that its mirror image completes.
void add_button(BodyMesh& mesh, const Vec3& center, float radius, const Vec3& color) {
    constexpr int kSides = 3;
    BodyRing last;
    for (const float out : {-0.003f, 0.0012f}) {
        BodyRing ring;
        ring.closed = false;
        ring.v = out;
        for (int i = 0; i <= kSides; ++i) {
            const float angle = kPi * static_cast<float>(i) / kSides;
            const float x = i == 0 || i == kSides ? 0.0f : radius * std::sin(angle);
            ring.vertices.push_back(
                mesh.add(trim_vertex(center + Vec3(x, radius * std::cos(angle), out), color)));
        }
        if (last.vertices.empty()) {
            mesh.cap(ring, Vec3(0), kTrimColumn, false);
        } else {
            mesh.join(last, ring, kTrimColumn);
        }
        last = ring;
    }
    mesh.cap(last, Vec3(0), kTrimColumn, true);
}

/// From the point of the leaf around the neck to the back.
void add_collar_leaf(BodyMesh& mesh, const PersonFrame& frame, bool coat) {
    constexpr std::array<float, 11> kAngles = {0.10f, 0.24f, 0.42f, 0.65f, 0.92f, 1.22f,
                                               1.55f, 1.90f, 2.30f, 2.72f, kPi};
    BodyRing last;
    for (const float angle : kAngles) {
        const float tip = glm::smoothstep(1.15f, 0.1f, angle) * (coat ? 0.052f : 0.034f);
        const float nape = glm::smoothstep(1.5f, 2.6f, angle) * (coat ? 0.012f : 0.006f);
        // Short over the shoulders, whose slope it would stand off.
        const float short_by = 0.011f * std::exp(-square((angle - 1.5f) / 0.6f));
        const float edge = (coat ? 1.462f : 1.468f) - tip - nape + short_by;
        const float lie = coat ? 0.008f : 0.006f;
        const float thick = coat ? 0.004f : 0.0025f;
        const std::array<Vec2, 6> profile = {{
            {1.500f, 0.0035f},
            {1.501f, 0.0075f},
            {0.4f * edge + 0.6f * 1.498f, 0.0085f + 0.3f * thick},
            {edge, lie + thick},
            {edge + 0.001f, lie},
            {1.487f, 0.0045f},
        }};
        BodyRing ring;
        ring.v = 0.1f * angle;
        for (const Vec2& at : profile) {
            const Vec3 p = shirt_point(frame, at.x, angle, at.y);
            BodyVertex vertex = trim_vertex(p, frame.look.shape.shirt_color);
            vertex.lift = Vec3(0, 0, 1);
            ring.vertices.push_back(mesh.add(vertex));
        }
        if (last.vertices.empty()) {
            mesh.cap(ring, Vec3(0), kLeafColumn, false);
        } else {
            mesh.join(last, ring, kLeafColumn);
        }
        last = ring;
    }
}

void add_placket(BodyMesh& mesh, const PersonFrame& frame, bool coat) {
    const float half = coat ? 0.030f : 0.016f;
    const std::vector<float> heights = shirt_rows(frame);
    // One row of the patch for each row of the shirt, whose facets it follows.
    const auto count = static_cast<int>(heights.size()) - 2;
    add_patch(
        mesh,
        {.columns = 1,
         .rows = count,
         .middle = true,
         .thick = coat ? 0.0055f : 0.0035f,
         .size = {half, kShirtTop - heights.front()},
         .color = 0.97f * frame.look.shape.shirt_color},
        [&](float across, float along, float grow) {
            const auto row =
                static_cast<std::size_t>(std::lround(along * static_cast<float>(count)));
            const float height = heights[heights.size() - 1 - row];
            return shirt_point(frame, height, angle_beside(frame, height, across * half), grow);
        });
}

}  // namespace

void add_shirt_trims(BodyMesh& mesh, const PersonFrame& frame) {
    const PersonTop top = frame.look.shape.top;
    const bool coat = top == PersonTop::Coat;
    if ((!coat && top != PersonTop::Shirt) || !shows(frame, kCollarTriangles)) {
        return;
    }
    add_collar_leaf(mesh, frame, coat);
    if (!shows(frame, kTrimTriangles)) {
        return;
    }
    add_placket(mesh, frame, coat);
    const Vec3& cloth = frame.look.shape.shirt_color;
    const Vec3 button = coat ? Vec3(0.03f) : glm::mix(cloth, Vec3(0.6f), 0.6f);
    const float step = coat ? 0.12f : 0.088f;
    const float lowest = std::max(shirt_hem(frame) + 0.05f, coat ? 0.80f : 0.0f);
    for (float height = coat ? 1.36f : 1.415f; height > lowest; height -= step) {
        const Vec3 center = shirt_point(frame, height, 0, coat ? 0.0075f : 0.0046f);
        add_button(mesh, center, coat ? 0.010f : 0.0058f, button);
    }
    const Patch pocket = {
        .columns = 3, .rows = 2, .thick = 0.0026f, .size = {0.06f, 0.1f}, .color = 0.96f * cloth};
    if (coat) {
        add_patch(mesh, pocket, [&](float across, float along, float grow) {
            return shirt_point(frame, 0.935f - 0.045f * along, 0.55f + 0.5f * across, grow);
        });
    } else if (frame.man > 0.5f || frame.look.folds % 4 == 0) {
        add_patch(mesh, pocket, [&](float across, float along, float grow) {
            return shirt_point(frame, 1.30f - 0.10f * along, 0.42f + 0.42f * across, grow);
        });
    }
}

void add_trouser_trims(BodyMesh& mesh, const PersonFrame& frame) {
    const PersonLegwear legs = frame.look.shape.legs;
    const bool legged = legs == PersonLegwear::Trousers || legs == PersonLegwear::Shorts;
    if (!legged || !shows(frame, kTrimTriangles)) {
        return;
    }
    const Vec3& cloth = frame.look.shape.trousers_color;
    if (shirt_hem(frame) > 0.88f) {  // not under a coat
        add_patch(
            mesh, {.columns = 2, .rows = 2, .thick = 0.002f, .color = 0.85f * cloth},
            [&](float across, float along, float grow) {
                const float height = 0.905f - 0.055f * along;
                return waist_point(frame, height, 2.42f + 0.42f * across, grow);
            });
    }
    if (!frame.look.tucked) {
        return;
    }
    add_patch(
        mesh, {.columns = 1, .rows = 3, .thick = 0.0018f, .color = 0.8f * cloth},
        [&](float across, float along, float grow) {
            const float angle = 0.92f + 0.42f * along + 0.05f * across;
            return waist_point(frame, 0.978f - 0.075f * along, angle, grow);
        });
    add_patch(
        mesh, {.columns = 1, .rows = 3, .middle = true, .thick = 0.0025f, .color = 0.9f * cloth},
        [&](float across, float along, float grow) {
            return waist_point(frame, 0.984f - 0.09f * along, 0.09f * across, grow);
        });
    for (const float angle : {0.52f, 1.5f, 2.5f}) {
        add_patch(
            mesh, {.columns = 1, .rows = 1, .thick = 0.003f, .color = cloth},
            [&](float across, float along, float grow) {
                return waist_point(frame, 1.009f - 0.028f * along, angle + 0.05f * across, grow);
            });
    }
    add_patch(
        mesh,
        {.columns = 1,
         .rows = 1,
         .middle = true,
         .thick = 0.004f,
         .color = Vec3(0.24f, 0.23f, 0.2f)},
        [&](float across, float along, float grow) {
            return waist_point(frame, 1.006f - 0.020f * along, 0.12f * across, grow);
        });
}

}  // namespace limn
