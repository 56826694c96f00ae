#include "content/bake/tangents.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_parts.h"
#include "content/make/head/head_wrap.h"
#include "content/make/person/person_face.h"
#include "content/make/person/person_head_shape.h"
#include "content/make/person/person_parts.h"
#include "content/make/person/person_weights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

// Techniques: engine.lod-mesh

namespace limn {

namespace {

/// Rings that continue the neck down into the collar.
constexpr int kNeckRings = 3;

/// Skin of a head as triangles of shared vertices, at the reference height.
struct WovenHead {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<Vec3> colors;
    std::vector<Vec2> charts;  ///< columns and rows of head_layout.h
    std::vector<HeadPoint> points;
    std::vector<float> steps;  ///< at lips and the edges of lids, whose outlines are kept, 0 .. 1
    std::vector<std::uint32_t> indices;
};

/// Each vertex, or the one of the upper lip where both lips touch.
std::vector<std::uint32_t> close_lips(const HeadLayout& layout) {
    std::vector<std::uint32_t> same(layout.vertices.size());
    std::vector<std::uint32_t> edge;
    for (std::uint32_t v = 0; v < same.size(); ++v) {
        same[v] = v;
        const HeadVertex& vertex = layout.vertices[v];
        if (vertex.loops == HeadLoops::Mouth && vertex.loop == kLipLoop) {
            edge.push_back(v);
        }
    }
    // In order of their angle: the first is the left corner, then the upper lip.
    for (std::size_t k = edge.size() / 2 + 1; k < edge.size(); ++k) {
        same[edge[k]] = edge[edge.size() - k];
    }
    return same;
}

/// Lips that open touch, but are two surfaces: the lower one a tenth of a millimeter apart. With
/// few triangles, the mouth behind them has to be smaller than that of a fine head.
Vec3 part_lips(const HeadVertex& vertex, Vec3 p) {
    constexpr Vec3 kMouth = {0, -3.4f, 8.6f};
    if (vertex.loops != HeadLoops::Mouth || vertex.loop < kLipLoop) {
        return p;
    }
    if (vertex.loop > kLipLoop + 2) {
        return glm::mix(p, kMouth, 0.12f * static_cast<float>(vertex.loop - kLipLoop - 2));
    }
    p.y -= std::sin(vertex.angle) < -1e-3f ? 0.01f : 0.0f;
    return p;
}

bool is_in_mouth(const HeadVertex& vertex) {
    return vertex.loops == HeadLoops::Mouth && vertex.loop > kLipLoop;
}

void append_triangles(WovenHead& head, const std::array<std::uint32_t, 4>& quad) {
    const auto length = [&](int a, int b) {
        return glm::distance(head.positions[quad[a]], head.positions[quad[b]]);
    };
    const std::uint32_t first = length(0, 2) <= length(1, 3) ? 0 : 1;
    for (const std::uint32_t second : {1u, 2u}) {
        const std::uint32_t a = quad[first];
        const std::uint32_t b = quad[(first + second) % 4];
        const std::uint32_t c = quad[(first + second + 1) % 4];
        if (a != b && b != c && c != a) {  // else the quad has lost a corner
            head.indices.insert(head.indices.end(), {a, b, c});
        }
    }
}

/// Down to the chest, closed by a fan.
void add_neck(WovenHead& head, const PersonFrame& frame, std::vector<std::uint32_t> ring) {
    std::vector<std::uint32_t> upper = ring;
    const Vec3 skin = frame.look.skin_color;
    std::vector<std::uint32_t> lower;
    for (int r = 1; r <= kNeckRings; ++r) {
        lower.clear();
        const float t = static_cast<float>(r) / kNeckRings;
        for (const std::uint32_t v : ring) {
            const Vec3 p = head.positions[v];
            const float angle = std::atan2(p.x, p.z + 0.015f);
            const float front = square(0.5f + 0.5f * std::cos(angle));
            const Vec3 edge = trunk_point(frame, 1.468f - 0.03f * front, angle, -0.003f);
            const Vec3 base = trunk_point(frame, 1.43f - 0.02f * front, angle, -0.012f);
            lower.push_back(static_cast<std::uint32_t>(head.positions.size()));
            head.positions.push_back(
                r == kNeckRings ? base
                                : glm::mix(p, edge, static_cast<float>(r) / (kNeckRings - 1)));
            head.colors.push_back(skin);
            head.charts.push_back(head.charts[v] + Vec2(0, 3 * t));
            head.points.push_back(bone_point(Vec3(0), 0));
            head.steps.push_back(0);
        }
        for (std::size_t j = 0; j < ring.size(); ++j) {
            const std::size_t next = (j + 1) % ring.size();
            append_triangles(head, {upper[j], lower[j], lower[next], upper[next]});
        }
        upper = lower;
    }
    Vec3 center(0);
    for (const std::uint32_t v : lower) {
        center += head.positions[v] / static_cast<float>(lower.size());
    }
    const auto middle = static_cast<std::uint32_t>(head.positions.size());
    head.positions.push_back(center - Vec3(0, 0.01f, 0));
    head.colors.push_back(skin);
    head.charts.emplace_back(0, kHeadRows + 6);
    head.points.push_back(bone_point(Vec3(0), 0));
    head.steps.push_back(0);
    for (std::size_t j = 0; j < lower.size(); ++j) {
        head.indices.insert(head.indices.end(), {lower[j], middle, lower[(j + 1) % lower.size()]});
    }
}

WovenHead weave_head(const PersonFrame& frame) {
    const HeadShape shape = person_head_shape(frame);
    const HeadLayout& layout = head_layout();
    const bool opens = has_face_shapes(frame.look.shape);
    std::vector<Vec3> wrapped = wrap_head(shape);
    std::vector<std::uint32_t> same = close_lips(layout);
    if (opens) {
        std::iota(same.begin(), same.end(), 0u);
    }
    WovenHead head;
    std::map<int, std::uint32_t> neck;
    for (std::uint32_t v = 0; v < wrapped.size(); ++v) {
        const HeadVertex& vertex = layout.vertices[v];
        wrapped[v] = opens ? part_lips(vertex, wrapped[v]) : wrapped[v];
        head.positions.push_back(head_in_body(frame, wrapped[v]));
        head.points.push_back(skin_point(vertex, wrapped[v]));
        const bool lash = !opens && vertex.loops == HeadLoops::Eye && vertex.loop == kLidLoop
                          && std::sin(vertex.angle) > 0.1f;
        Vec3 tint = head_skin_color(vertex, wrapped[v], shape);
        if (vertex.loops == HeadLoops::Mouth) {  // few triangles spread it: a little less of it
            tint = glm::mix(Vec3(1), tint, glm::mix(0.8f, 0.5f, frame.man));
        }
        if (is_in_mouth(vertex)) {
            const float deep =
                static_cast<float>(vertex.loop - kLipLoop) / (kMouthLoops - kLipLoop);
            tint = Vec3(0.42f, 0.16f, 0.14f) * (1 - 0.85f * deep);
        }
        const bool is_lip = opens && vertex.loops == HeadLoops::Mouth && vertex.loop <= kLipLoop;
        const bool is_lid = opens && vertex.loops == HeadLoops::Eye
                            && (vertex.loop == kLidLoop || vertex.loop == kLidLoop + 1);
        head.steps.push_back(is_lip ? 1 - tint.y : is_lid ? 0.3f : 0.0f);
        head.colors.push_back((lash ? 0.5f : 1.0f) * frame.look.skin_color * tint);
        head.charts.push_back(vertex.chart);
        if (vertex.loops == HeadLoops::None && vertex.chart.y == kHeadRows) {
            neck[static_cast<int>(std::lround(vertex.chart.x))] = v;
        }
    }
    for (const auto& quad : layout.quads) {
        const bool hidden = !opens && std::any_of(quad.begin(), quad.end(), [&](std::uint32_t v) {
            return is_in_mouth(layout.vertices[v]);
        });
        if (!hidden) {
            append_triangles(head, {same[quad[0]], same[quad[1]], same[quad[2]], same[quad[3]]});
        }
    }
    std::vector<std::uint32_t> ring;
    for (const auto& [column, v] : neck) {
        ring.push_back(v);
    }
    add_neck(head, frame, std::move(ring));
    head.normals.assign(head.positions.size(), Vec3(0));
    for (std::size_t i = 0; i < head.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return head.positions[head.indices[i + k]]; };
        const Vec3 area = glm::cross(at(1) - at(0), at(2) - at(0));
        for (std::size_t k = 0; k < 3; ++k) {
            head.normals[head.indices[i + k]] += area;
        }
    }
    return head;
}

/// Whether two triangles have an edge in the same direction.
bool has_crowded_edge(const WovenHead& head, const std::vector<std::uint32_t>& indices) {
    std::map<std::array<float, 3>, std::uint32_t> places;
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    const auto place = [&](std::size_t i) {
        const Vec3& p = head.positions[indices[i]];
        return places.try_emplace({p.x, p.y, p.z}, indices[i]).first->second;
    };
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = place(i + k);
            const std::uint32_t b = place(i + (k + 1) % 3);
            if (a != b && !edges.emplace(a, b).second) {
                return true;
            }
        }
    }
    return false;
}

/// Removes pairs of triangles that are the two sides of one, which collapses may leave.
void remove_flaps(std::vector<std::uint32_t>& indices) {
    using Corners = std::array<std::uint32_t, 3>;
    const auto sorted = [&](std::size_t i) {
        Corners corners = {indices[i], indices[i + 1], indices[i + 2]};
        std::ranges::sort(corners);
        return corners;
    };
    std::map<Corners, int> sides;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        ++sides[sorted(i)];
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        if (sides.at(sorted(i)) == 1) {
            kept.insert(kept.end(), {indices[i], indices[i + 1], indices[i + 2]});
        }
    }
    indices = std::move(kept);
}

/// 1 at the mouth and the eyes, 0 far from them.
float near_features(const PersonFrame& frame, const Vec3& p) {
    const Vec3 q = (p - frame.head_origin) / frame.head_scale;
    const Vec3 side = q * Vec3(q.x < 0 ? -1 : 1, 1, 1);
    return std::exp(-square(glm::distance(side, Vec3(0.018f, -0.033f, 0.100f)) / 0.024f))
           + std::exp(-square(glm::distance(side, Vec3(0.036f, 0.035f, 0.083f)) / 0.024f));
}

/// Adds the normals of the triangles that are left where a lid or the corner of the mouth has few:
/// those of the fine skin alone would show each of them.
void blend_normals(WovenHead& head, const PersonFrame& frame) {
    std::vector<Vec3> own(head.positions.size(), Vec3(0));
    for (std::size_t i = 0; i < head.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return head.positions[head.indices[i + k]]; };
        const Vec3 area = glm::cross(at(1) - at(0), at(2) - at(0));
        for (std::size_t k = 0; k < 3; ++k) {
            own[head.indices[i + k]] += area;
        }
    }
    std::vector<float> share(own.size());
    for (std::size_t v = 0; v < own.size(); ++v) {
        share[v] = std::min(near_features(frame, head.positions[v]), 1.0f);
        head.normals[v] = normalize_or(head.normals[v], Vec3(0))
                          + 3.0f * share[v] * normalize_or(own[v], Vec3(0));
        head.normals[v] = normalize_or(head.normals[v], Vec3(0));
    }
    std::vector<Vec3> sums = head.normals;
    for (std::size_t i = 0; i < head.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = head.indices[i + k];
            sums[v] += 0.5f * share[v] * head.normals[head.indices[i + (k + 1) % 3]];
        }
    }
    head.normals = std::move(sums);
}

/// Collapses edges where it shows least: in a space where the face is larger, and smaller what is
/// under hair or clothes.
void reduce(WovenHead& head, const PersonFrame& frame) {
    constexpr float kMaxHeadError = 0.05f;
    constexpr int kMaxAttempts = 64;
    constexpr float kStep = 0.03f;  // that lips and lids stand out for it [m]
    const bool bald = frame.look.shape.hair == PersonHair::Bald;
    const bool opens = has_face_shapes(frame.look.shape);
    std::vector<Vec3> warped;
    for (const Vec3& p : head.positions) {
        const Vec3 q = (p - frame.head_origin) / frame.head_scale;
        const float face = glm::smoothstep(0.02f, 0.08f, q.z) * glm::smoothstep(-0.10f, -0.05f, q.y)
                           * (1 - glm::smoothstep(0.06f, 0.10f, q.y));
        const Vec3 side = q * Vec3(q.x < 0 ? -1 : 1, 1, 1);
        const float mouth = std::exp(-square(glm::distance(q, Vec3(0, -0.033f, 0.104f)) / 0.026f));
        const float eye =
            std::exp(-square(glm::distance(side, Vec3(0.0315f, 0.035f, 0.085f)) / 0.02f));
        const float hidden = bald ? 0.0f : glm::smoothstep(0.09f, 0.12f, q.y - 0.4f * q.z);
        const float below = 1 - glm::smoothstep(-0.16f, -0.13f, q.y);
        const std::size_t v = warped.size();
        warped.push_back(
            q * (1 + 1.2f * face + 0.6f * (mouth + eye)) * (1 - 0.75f * std::max(hidden, below))
            + kStep * head.steps[v] * normalize_or(head.normals[v], Vec3(0)));
    }
    std::vector<std::uint32_t> indices;
    // A collapse may join two layers of a lip or an ear: then a few triangles more or fewer.
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
        const int more = (attempt % 2 == 0 ? 12 : -12) * ((attempt + 1) / 2);
        const auto target =
            static_cast<std::size_t>(3 * std::max(frame.look.shape.head_triangles + more, 1));
        indices.resize(head.indices.size());
        indices.resize(meshopt_simplify(
            indices.data(), head.indices.data(), head.indices.size(), &warped[0].x, warped.size(),
            sizeof(Vec3), target, kMaxHeadError));
        if (opens) {
            remove_flaps(indices);
        }
        if (!has_crowded_edge(head, indices)) {
            break;
        }
    }
    head.indices = std::move(indices);
    blend_normals(head, frame);
}

/// Closed strips along the rows of the grid above the eyes, on the fine skin.
void add_brows(BodyMesh& mesh, const PersonFrame& frame, const WovenHead& head) {
    constexpr int kFirst = 4;  // columns
    constexpr int kLast = 16;
    const HeadLayout& layout = head_layout();
    std::map<std::pair<int, int>, std::uint32_t> grid;
    for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
        const HeadVertex& vertex = layout.vertices[v];
        if (vertex.loops == HeadLoops::None && vertex.chart.y >= 0) {
            grid[{
                static_cast<int>(std::lround(vertex.chart.x)),
                static_cast<int>(std::lround(vertex.chart.y))}] = v;
        }
    }
    const bool man = frame.look.shape.sex == PersonSex::Man;
    const Vec3 color =
        glm::mix(0.7f * frame.look.shape.hair_color, 0.3f * frame.look.skin_color, 0.3f);
    for (const int side : {1, -1}) {
        BodyRing last;
        for (int column = kFirst; column <= kLast; ++column) {
            const float t = static_cast<float>(column - kFirst) / (kLast - kFirst);
            const float half = (man ? 1.15f : 0.75f) * std::lerp(1.0f, 0.25f, t * t)
                               * std::min(0.6f + 3 * t, 1.0f);
            const float middle = 22.8f - (man ? 0.2f : 0.8f) * std::sin(kPi * t) + 0.3f * t;
            BodyRing ring;
            ring.v = 0.04f * t;
            const auto put = [&](float row, float out) {
                const int above = static_cast<int>(std::floor(row));
                const float s = row - static_cast<float>(above);
                const std::uint32_t a = grid.at({side * column, above});
                const std::uint32_t b = grid.at({side * column, above + 1});
                const Vec3 normal = normalize_or(head.normals[a], Vec3(0, 0, 1));
                BodyVertex vertex;
                vertex.position = glm::mix(head.positions[a], head.positions[b], s) + out * normal;
                vertex.color = color;
                vertex.zone = BodyZone::Head;
                ring.vertices.push_back(mesh.add(vertex));
            };
            put(middle - half, 0.0003f);
            put(middle - 0.3f * half, 0.0010f);
            put(middle + half, 0.0003f);
            put(middle, -0.0025f);
            if (last.vertices.empty()) {
                mesh.cap(ring, Vec3(0), 0.004f, false);
            } else {
                mesh.join(last, ring, 0.004f);
            }
            last = ring;
        }
        mesh.cap(last, Vec3(0), 0.004f, true);
    }
    mesh.face_outwards();
}

/// Lashes of the upper lids: closed strips along their edges, on the fine skin.
void add_lashes(BodyMesh& mesh, const PersonFrame& frame, const WovenHead& head) {
    constexpr std::size_t kEvery = 3;  // vertices of the lid from one ring to the next
    const HeadLayout& layout = head_layout();
    const float size = frame.head_scale * glm::mix(0.0045f, 0.003f, frame.man);
    for (const int side : {1, -1}) {
        std::vector<std::uint32_t> edge;
        for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
            const HeadVertex& vertex = layout.vertices[v];
            if (vertex.loops == HeadLoops::Eye && vertex.loop == kLidLoop
                && vertex.left == (side > 0) && std::sin(vertex.angle) > 0.02f) {
                edge.push_back(v);
            }
        }
        const Vec3 eye = frame.at(side > 0 ? PersonJoint::LeftEye : PersonJoint::RightEye);
        BodyRing last;
        for (std::size_t k = 0; k < edge.size(); k += kEvery) {
            const std::uint32_t v = edge[k];
            const float t = static_cast<float>(k) / static_cast<float>(edge.size() - 1);
            const Vec3 out = normalize_or(head.positions[v] - eye, Vec3(0, 0, 1));
            // From the outer corner (0) to the inner one, where they are short.
            const float length = size
                                 * std::sqrt(std::max(std::sin(kPi * (0.08f + 0.86f * t)), 0.0f))
                                 * std::lerp(1.0f, 0.45f, t);
            const Vec3 way(0.3f * static_cast<float>(side), 0.2f, 1);
            BodyRing ring;
            ring.v = 0.03f * t;
            for (const Vec3& offset :
                 {Vec3(0, 0.0008f, 0) + 0.0003f * out, -0.0004f * out, length * way}) {
                BodyVertex vertex;
                vertex.position = head.positions[v] + offset;
                vertex.color = 0.25f * glm::min(frame.look.shape.hair_color, Vec3(0.12f));
                vertex.zone = BodyZone::Head;
                ring.vertices.push_back(mesh.add(vertex));
            }
            if (last.vertices.empty()) {
                mesh.cap(ring, Vec3(0), 0.002f, false);
            } else {
                mesh.join(last, ring, 0.002f);
            }
            last = ring;
        }
        mesh.cap(last, Vec3(0), 0.002f, true);
    }
    mesh.face_outwards();
}

/// A row of teeth as one closed arch. `upper` 1, or -1.
void add_teeth(BodyMesh& mesh, const PersonFrame& frame, float upper) {
    constexpr int kColumns = 9;
    constexpr float kArchWidth = 2.6f;  // half; as in head_mouth.cpp [cm]
    constexpr float kArchDepth = 4.2f;
    const float front = upper > 0 ? 10.3f : 10.05f;
    const float edge = upper > 0 ? -3.70f : -3.62f;
    BodyRing last;
    for (int i = 0; i < kColumns; ++i) {
        const float turn = 1.15f * (2 * static_cast<float>(i) / (kColumns - 1) - 1);
        BodyRing ring;
        ring.v = 0.05f * static_cast<float>(i);
        for (const Vec2& corner : {Vec2(0, 1), Vec2(0, 0), Vec2(0.5f, 0), Vec2(0.5f, 1)}) {
            const Vec3 p(
                (kArchWidth - corner.x) * std::sin(turn), edge + 0.95f * upper * corner.y,
                front - corner.x - (kArchDepth - corner.x) * (1 - std::cos(turn)));
            BodyVertex vertex;
            vertex.position = head_in_body(frame, p);
            vertex.color = Vec3(0.5f, 0.46f, 0.38f) * std::lerp(1.0f, 0.55f, corner.y);
            vertex.zone = BodyZone::Head;
            ring.vertices.push_back(mesh.add(vertex));
        }
        if (last.vertices.empty()) {
            mesh.cap(ring, Vec3(0), 0.01f, false);
        } else {
            mesh.join(last, ring, 0.01f);
        }
        last = ring;
    }
    mesh.cap(last, Vec3(0), 0.01f, true);
    mesh.face_outwards();
}

/// For what lies on the skin: it moves like the vertex of the fine skin nearest to it.
HeadPoint nearest_point(const WovenHead& head, const Vec3& p) {
    std::size_t nearest = 0;
    for (std::size_t v = 1; v < head.points.size(); ++v) {
        if (glm::distance(head.positions[v], p) < glm::distance(head.positions[nearest], p)) {
            nearest = v;
        }
    }
    return head.points[nearest];
}

/// As in the head's own chart; the neck ends at 1.
Vec2 chart_uv(const Vec2& chart) {
    return {0.5f + chart.x / kHeadColumns, (chart.y + 13) / (kHeadRows + 20)};
}

}  // namespace

HeadShape person_head_shape(const PersonFrame& frame) {
    HeadShape shape;
    shape.age = frame.look.shape.age;
    shape.sex = frame.look.sex * (1 - 0.8f * frame.child);
    shape.build = frame.look.shape.build;
    shape.asymmetry = frame.look.asymmetry;
    shape.scalp_shade = frame.look.shape.hair == PersonHair::Bald ? 0.25f : 0.7f;
    return shape;
}

Vec3 head_in_body(const PersonFrame& frame, Vec3 p) {
    constexpr float kEyeLine = 3.5f;
    const float below = glm::smoothstep(kEyeLine, -4.0f, p.y) * glm::smoothstep(-13.5f, -8.0f, p.y);
    p.y = kEyeLine + (p.y - kEyeLine) * (1 - 0.13f * frame.child * below);
    p.x *= 1 - 0.05f * frame.child * below;
    p.z -= 0.5f * frame.child * below;
    return frame.head_origin + 0.01f * frame.head_scale * p;
}

MeshData make_person_head(const PersonFrame& frame) {
    WovenHead head = weave_head(frame);
    BodyMesh brows;
    add_brows(brows, frame, head);
    const bool opens = has_face_shapes(frame.look.shape);
    if (opens) {
        add_lashes(brows, frame, head);
    }
    reduce(head, frame);
    MeshData mesh;
    std::vector<HeadPoint> points;
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> made;  // copies beyond the seam
    for (std::size_t i = 0; i < head.indices.size(); i += 3) {
        float high = -kHeadColumns;
        for (std::size_t k = 0; k < 3; ++k) {
            high = std::max(high, head.charts[head.indices[i + k]].x);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = head.indices[i + k];
            const bool beyond = head.charts[v].x < high - 0.5f * kHeadColumns;
            const auto [found, added] =
                made.try_emplace({v, beyond}, static_cast<std::uint32_t>(mesh.positions.size()));
            if (added) {
                points.push_back(head.points[v]);
                mesh.positions.push_back(head.positions[v]);
                mesh.normals.push_back(normalize_or(head.normals[v], Vec3(0, 1, 0)));
                mesh.colors.emplace_back(head.colors[v], 1.0f);
                mesh.uvs.push_back(chart_uv(head.charts[v] + Vec2(beyond ? kHeadColumns : 0, 0)));
                append_weights(mesh.skin, head_weights_at(frame, head.positions[v]));
            }
            mesh.indices.push_back(found->second);
        }
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    generate_tangents(mesh);
    update_bounds(mesh);
    append_part(mesh, brows.finish(frame, kPi));
    if (opens) {
        // Brows, lashes, and what the tangents have split.
        for (std::size_t v = points.size(); v < mesh.positions.size(); ++v) {
            points.push_back(nearest_point(head, mesh.positions[v]));
        }
        for (const float upper : {1.0f, -1.0f}) {
            BodyMesh teeth;
            add_teeth(teeth, frame, upper);
            append_part(mesh, teeth.finish(frame, kPi));
            points.resize(mesh.positions.size(), bone_point(Vec3(0), 0.5f - 0.5f * upper));
        }
        add_face_shapes(mesh, points, frame);
    }
    return mesh;
}

}  // namespace limn
