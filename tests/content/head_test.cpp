#include "content/make/head/head.h"
#include "content/make/head/head_ear.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_parts.h"
#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace limn::head_test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Directed edges of all quads, and how often each occurs.
std::map<Edge, int> directed_edges() {
    std::map<Edge, int> edges;
    for (const auto& quad : head_layout().quads) {
        for (int k = 0; k < 4; ++k) {
            ++edges[{quad[k], quad[(k + 1) % 4]}];
        }
    }
    return edges;
}

const std::vector<Vec3>& wrapped() {
    static const std::vector<Vec3> positions = wrap_head(HeadShape{});
    return positions;
}

TEST_CASE("head: the skin is a disc whose border is the ring of the neck") {
    const std::map<Edge, int> edges = directed_edges();
    int border = 0;
    int both = 0;
    for (const auto& [edge, count] : edges) {
        CHECK(count == 1);  // neighbors agree which side is outside
        if (edges.contains({edge.second, edge.first})) {
            ++both;
        } else {
            ++border;
            CHECK(head_layout().vertices[edge.first].chart.y == kHeadRows);
        }
    }
    CHECK(border == kHeadColumns);
    const int euler = static_cast<int>(head_layout().vertices.size()) - (both / 2 + border)
                      + static_cast<int>(head_layout().quads.size());
    CHECK(euler == 1);
    CHECK(head_layout().vertices.size() >= 10000);
    CHECK(head_layout().vertices.size() <= 20000);
}

TEST_CASE("head: each vertex has a mirror image, and without asymmetry the halves agree") {
    const HeadLayout& layout = head_layout();
    for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
        const std::uint32_t other = layout.mirror[v];
        CHECK(layout.mirror[other] == v);
        const Vec3 p = wrapped()[other];
        CHECK(glm::length(wrapped()[v] - Vec3(-p.x, p.y, p.z)) < 1e-4f);
    }
}

TEST_CASE("head: width and length are within two deviations of an adult's") {
    Vec3 low = Vec3(100);
    Vec3 high = Vec3(-100);
    for (std::size_t v = 0; v < wrapped().size(); ++v) {
        if (head_layout().vertices[v].loops == HeadLoops::None && wrapped()[v].y > 5) {
            low = glm::min(low, wrapped()[v]);
            high = glm::max(high, wrapped()[v]);
        }
    }
    CHECK(high.x - low.x > 13.4f);  // Zhuang and Bradtmiller 2005 [cm]
    CHECK(high.x - low.x < 16.5f);
    CHECK(high.z - low.z > 17.3f);
    CHECK(high.z - low.z < 21.2f);
}

TEST_CASE("head: lids do not enter the eyeball") {
    for (std::size_t v = 0; v < wrapped().size(); ++v) {
        Vec3 p = wrapped()[v];
        p.x = std::abs(p.x);
        CHECK(glm::length(p - kEyeCenter) > kEyeRadius);
    }
}

/// Vertices of loops `from` to `to` on the left side.
std::vector<std::uint32_t> left_loops(HeadLoops loops, int from, int to) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < wrapped().size(); ++v) {
        const HeadVertex& vertex = head_layout().vertices[v];
        if (vertex.left && vertex.loops == loops && vertex.loop >= from && vertex.loop <= to) {
            found.push_back(v);
        }
    }
    return found;
}

Vec3 mean_position(const std::vector<std::uint32_t>& vertices) {
    Vec3 sum = Vec3(0);
    for (const std::uint32_t v : vertices) {
        sum += wrapped()[v];
    }
    return sum / static_cast<float>(vertices.size());
}

/// Sum over the quads between `vertices` of area times normal.
Vec3 facing(const std::vector<std::uint32_t>& vertices) {
    Vec3 sum = Vec3(0);
    for (const auto& quad : head_layout().quads) {
        if (std::ranges::all_of(
                quad, [&](std::uint32_t v) { return std::ranges::binary_search(vertices, v); })) {
            sum += glm::cross(
                wrapped()[quad[2]] - wrapped()[quad[0]], wrapped()[quad[3]] - wrapped()[quad[1]]);
        }
    }
    return glm::normalize(sum);
}

TEST_CASE("head: a nostril opens downwards and ends 8 mm or more up, within the nose") {
    const auto rim = left_loops(HeadLoops::Nostril, kNostrilRim, kNostrilRim);
    const auto cavity = left_loops(HeadLoops::Nostril, kNostrilRim, kNostrilLoops);
    const auto end = left_loops(HeadLoops::Nostril, kNostrilLoops, kNostrilLoops);
    REQUIRE(rim.size() >= 16);
    CHECK(facing(cavity).y < -0.8f);
    CHECK(mean_position(end).y - mean_position(rim).y > 0.8f);
    Vec3 rim_low = Vec3(100);
    Vec3 rim_high = Vec3(-100);
    for (const std::uint32_t v : rim) {
        rim_low = glm::min(rim_low, wrapped()[v]);
        rim_high = glm::max(rim_high, wrapped()[v]);
    }
    CHECK(rim_high.x - rim_low.x > 0.55f);  // [cm]
    CHECK(glm::length(rim_high - rim_low) > 1.0f);
    for (const std::uint32_t v : end) {  // a hole: no light returns from it
        const Vec3 color = head_skin_color(head_layout().vertices[v], wrapped()[v], HeadShape{});
        CHECK(color.x < 0.05f);
    }
    for (const std::uint32_t v : left_loops(HeadLoops::Nostril, kNostrilRim + 2, kNostrilLoops)) {
        CHECK(head_distance(wrapped()[v], HeadShape{}, 1) < 0);
    }
    for (const std::uint32_t v : rim) {  // a column stays between the nostrils
        CHECK(wrapped()[v].x > 0.2f);
    }
}

/// Vertices of a loop around the mouth, in the order of their angle.
std::vector<std::uint32_t> mouth_loop(int loop) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < wrapped().size(); ++v) {
        const HeadVertex& vertex = head_layout().vertices[v];
        if (vertex.loops == HeadLoops::Mouth && vertex.loop == loop) {
            found.push_back(v);
        }
    }
    std::ranges::sort(found, {}, [](std::uint32_t v) { return head_layout().vertices[v].angle; });
    return found;
}

TEST_CASE("head: the red of the lips ends in an even line, 8 and 9 mm from where they touch") {
    const auto border = mouth_loop(kLipBorderLoop);
    const auto line = mouth_loop(kLipLoop);
    REQUIRE(border.size() == line.size());
    float upper = 0;
    float lower = 0;
    float uneven = 0;
    for (std::size_t k = 0; k < border.size(); ++k) {
        const Vec3 p = wrapped()[border[k]];
        const Vec3 before = wrapped()[border[(k + border.size() - 1) % border.size()]];
        const Vec3 after = wrapped()[border[(k + 1) % border.size()]];
        const float height = p.y - wrapped()[line[k]].y;
        upper = std::max(upper, height);
        lower = std::max(lower, -height);
        if (std::abs(p.x) < 2.2f) {  // it turns back at the corners
            uneven = std::max(uneven, std::abs(0.5f * (before.y + after.y) - p.y));
        }
    }
    CHECK(upper > 0.65f);  // Farkas 1994: 8.0 and 9.3, deviation 1.5 [cm]
    CHECK(upper < 0.95f);
    CHECK(lower > 0.78f);
    CHECK(lower < 1.08f);
    CHECK(uneven < 0.015f);  // [cm], viewed from the front; columns are 1.5 mm apart
}

TEST_CASE("head: skin at the corners of the mouth is without spikes and notches") {
    // Beside a corner the loops of the lips come close together, but stay on the surface.
    for (int loop = kLipBorderLoop - 1; loop < kLipLoop; ++loop) {
        const auto ring = mouth_loop(loop);
        const auto inner = mouth_loop(loop + 1);
        const Vec3 corner = wrapped()[ring[0]];
        CHECK(corner.x > wrapped()[inner[0]].x);
        CHECK(corner.x - wrapped()[inner[0]].x < 0.15f);
        CHECK(std::abs(head_distance(corner, HeadShape{}, 1)) < 0.05f);
        CHECK(std::abs(corner.y - wrapped()[inner[0]].y) < 0.02f);
    }
}

TEST_CASE("head: upper and lower lip do not intersect, at rest nor while AU25 parts them") {
    for (int loop = kLipBorderLoop; loop <= kLipLoop; ++loop) {
        const auto ring = mouth_loop(loop);
        for (std::size_t k = 1; k < ring.size() / 2; ++k) {
            const auto at = [&](std::size_t i, float weight) {
                const std::uint32_t v = ring[i];
                const HeadPoint point = skin_point(head_layout().vertices[v], wrapped()[v]);
                return point.rest + weight * action_offset(action_unit("AU25"), point, HeadShape{});
            };
            for (const float weight : {0.0f, 0.5f, 1.0f}) {
                CHECK(at(k, weight).y >= at(ring.size() - k, weight).y - 1e-4f);
            }
        }
    }
}

TEST_CASE(
    "head: an ear is as long and wide as an adult's, and its concha a hollow that faces out") {
    constexpr int kConcha = 22;
    const auto front = left_loops(HeadLoops::Ear, 6, kEarLoops);
    Vec3 low = Vec3(100);
    Vec3 high = Vec3(-100);
    for (const std::uint32_t v : front) {
        low = glm::min(low, wrapped()[v]);
        high = glm::max(high, wrapped()[v]);
    }
    CHECK(high.y - low.y > 5.5f);  // 62.4 mm, two deviations 7.4
    CHECK(high.y - low.y < 7.0f);
    CHECK(facing(front).x > 0.7f);
    const Vec3 concha = mean_position(left_loops(HeadLoops::Ear, kConcha, kEarLoops));
    CHECK(high.x - concha.x > 0.8f);  // the helix stands out from it
    const Vec3 head = project_to_head(concha, HeadShape{}, 1);
    CHECK(glm::distance(head, concha) < 0.6f);
}

/// Breadths [cm], seen from the front, and the circumference of the neck below the jaw.
struct NeckSize {
    float neck = 100;
    float head = 0;
    float around = 0;
};

NeckSize neck_size(const HeadShape& shape) {
    const HeadLayout& layout = head_layout(shape.shoulders);
    const std::vector<Vec3> skin = wrap_head(shape);
    NeckSize size;
    for (float y = -7; y > -12; y -= 0.25f) {
        float widest = 0;
        for (const Vec3& p : skin) {
            widest = std::abs(p.y - y) < 0.4f ? std::max(widest, 2 * p.x) : widest;
        }
        size.neck = std::min(size.neck, widest);
    }
    for (std::size_t v = 0; v < skin.size(); ++v) {
        const bool skull = skin[v].y > 3 && layout.vertices[v].loops == HeadLoops::None;
        size.head = std::max(size.head, skull ? 2 * skin[v].x : 0.0f);
    }
    // Where a tape lies: across the axis of the neck, which leans forward.
    constexpr int kSteps = 72;
    Vec3 last(0);
    for (int i = 0; i <= kSteps; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kSteps;
        Vec3 p = {12 * std::sin(angle), 0, -1.8f + 12 * std::cos(angle)};
        for (int step = 0; step < 60; ++step) {
            p.y = -10 - 0.17f * (p.z + 1.8f);
            const Vec3 in = glm::normalize(Vec3(0, p.y, -1.8f) - p);
            p += 0.5f * head_distance(p, shape, 1) * in;
        }
        size.around += i > 0 ? glm::distance(p, last) : 0.0f;
        last = p;
    }
    return size;
}

TEST_CASE(
    "head: necks have the breadth of women's and men's, relative to the head, and the girth") {
    for (const bool shoulders : {false, true}) {
        const auto size = [&](float sex, float build) {
            return neck_size({.sex = sex, .build = build, .shoulders = shoulders});
        };
        const NeckSize woman = size(-1, 0);
        const NeckSize man = size(1, 0);
        const NeckSize between = size(0, 0);
        CAPTURE(woman.neck / woman.head);
        CAPTURE(between.neck / between.head);
        CAPTURE(man.neck / man.head);
        CAPTURE(woman.around);
        CAPTURE(man.around);
        // Breadths measured on photographs from the front.
        CHECK(woman.neck > 0.62f * woman.head);
        CHECK(woman.neck < 0.68f * woman.head);
        CHECK(man.neck > 0.75f * man.head);
        CHECK(man.neck < 0.8f * man.head);
        CHECK(between.neck > 0.68f * between.head);
        CHECK(between.neck < 0.75f * between.head);
        // Zhuang and Bradtmiller 2005, within a deviation [cm].
        CHECK(std::abs(woman.around - 33.7f) < 2.5f);
        CHECK(std::abs(man.around - 40.6f) < 3.3f);
        CHECK(size(0, 1).neck > between.neck);
    }
}

TEST_CASE("head: the neck ends in a planar ring that turns once around") {
    float turned = 0;
    std::vector<Vec3> ring;
    for (std::size_t v = 0; v < wrapped().size(); ++v) {
        if (head_layout().vertices[v].chart.y == kHeadRows) {
            CHECK(wrapped()[v].y == test::near(-14.5f));
            ring.push_back(wrapped()[v]);
        }
    }
    REQUIRE(ring.size() == kHeadColumns);
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec3 edge = ring[(k + 1) % ring.size()] - ring[k];
        const Vec3 next = ring[(k + 2) % ring.size()] - ring[(k + 1) % ring.size()];
        const float turn = std::asin(glm::cross(glm::normalize(edge), glm::normalize(next)).y);
        CHECK(turn > -0.15f);  // hollows beside the throat are shallow
        turned += turn;
    }
    CHECK(std::abs(turned - 2 * kPi) < 1e-3f);
}

TEST_CASE("head: no ridge of the ear forms a spike, not even where ridges meet") {
    float highest = 0;
    for (float x = -1.2f; x <= 2; x += 0.02f) {
        for (float y = -2.9f; y <= 2.9f; y += 0.02f) {
            const bool inside = glm::length(Vec2(x, y)) <= ear_outline(std::atan2(y, x));
            highest = std::max(highest, inside ? ear_relief({x, y}) : 0.0f);
        }
    }
    CHECK(highest > 0.25f);  // the helix, in centimeters
    CHECK(highest < 0.5f);
}

TEST_CASE("head: the tear line lies on the lower lid and the ball, and follows the lid") {
    HeadPart corneas = make_corneas();
    const ActionUnit& blink = action_unit("AU43");
    int wet = 0;
    for (const HeadPoint& point : corneas.points) {
        if (point.loops != HeadLoops::Eye) {
            continue;
        }
        ++wet;
        const Vec3 p = {std::abs(point.rest.x), point.rest.y, point.rest.z};
        CHECK(p.y < kEyeCenter.y);
        const float radius = glm::distance(p, kEyeCenter);
        CHECK(radius > kBallRadius - 0.01f);
        CHECK(radius < kEyeRadius + kLidThickness);
        CHECK(action_offset(blink, point, HeadShape{}).y > -0.01f);  // up, as the lid does
    }
    CHECK(wet == 2 * 5 * 40);
}

TEST_CASE("head: a pupil reflects no light to the front: nothing dark in it faces forward") {
    const HeadPart balls = make_eye_balls();
    const MeshData& mesh = balls.mesh;
    int dark = 0;
    int forward = 0;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::uint32_t* const v = &mesh.indices[t];
        if (mesh.colors[v[0]].x + mesh.colors[v[1]].x + mesh.colors[v[2]].x > 0.02f) {
            continue;
        }
        const Vec3 a = mesh.positions[v[0]];
        const Vec3 normal = glm::cross(mesh.positions[v[1]] - a, mesh.positions[v[2]] - a);
        if (glm::length(normal) > 0) {
            ++dark;
            forward += glm::normalize(normal).z >= 0.5f ? 1 : 0;
        }
    }
    CHECK(dark > 200);
    CHECK(forward == 0);
}

TEST_CASE("head: a cornea has the radius and height of an eye's, and the iris lies 3 mm below") {
    constexpr float kScale = kBallRadius / 1.2f;  // of an eye whose ball has 24 mm
    float apex = 0;
    for (const HeadPoint& point : make_corneas().points) {
        apex = std::max(apex, point.eye > 0 ? point.rest.z - kEyeCenter.z : 0.0f);
    }
    CHECK(apex - kBallRadius == test::near(0.11f * kScale).epsilon(0.1));
    // Of the front surface, 7.8 mm (0.25): by what it sinks 3 mm from the axis.
    float sunk = 0;
    float iris = 0;
    for (const HeadPoint& point : make_corneas().points) {
        const Vec3 p = point.rest - kEyeCenter;
        const float radius2 = p.x * p.x + p.y * p.y;
        if (point.eye > 0 && radius2 > square(0.25f) && radius2 < square(0.36f)) {
            sunk = (radius2 + square(apex - p.z)) / (2 * (apex - p.z));
        }
    }
    CHECK(sunk > (0.78f - 0.05f) * kScale);
    CHECK(sunk < (0.78f + 0.05f) * kScale);
    for (const HeadPoint& point : make_eye_balls().points) {
        const Vec3 p = point.rest - kEyeCenter;
        if (point.eye > 0 && p.z > 0 && glm::length(Vec2(p.x, p.y)) < 0.5f) {
            iris = std::max(iris, p.z);
        }
    }
    CHECK(apex - iris > 0.27f);
    CHECK(apex - iris < 0.34f);
}

TEST_CASE("head: lashes grow from the edge of the lids") {
    int roots = 0;
    const HeadPart hair = make_face_hair(HeadShape{});
    for (std::size_t v = 0; v < hair.points.size(); ++v) {
        const HeadPoint& point = hair.points[v];
        if (point.loops == HeadLoops::Eye && hair.mesh.uvs[v].y == 0) {
            ++roots;
            CHECK(point.loop == kLidLoop);
            const Vec3 root = {std::abs(point.rest.x), point.rest.y, point.rest.z};
            CHECK(glm::distance(root, lid_margin(point.angle)) < 0.05f);  // [cm]
        }
    }
    CHECK(roots == 2 * 2 * (120 + 55));
}

TEST_CASE("head: the upper lid folds along a line 3 to 6 mm above its edge") {
    int folded = 0;
    for (const std::uint32_t v : left_loops(HeadLoops::Eye, kLidCreaseLoop, kLidCreaseLoop)) {
        const HeadVertex& vertex = head_layout().vertices[v];
        if (std::sin(vertex.angle) > 0.8f) {
            ++folded;
            const float above = wrapped()[v].y - lid_margin(vertex.angle).y;
            CHECK(above > 0.3f);
            CHECK(above < 0.6f);
            CHECK(std::abs(wrapped()[v].y - lid_crease(wrapped()[v].x)) < 0.1f);
        }
    }
    CHECK(folded > 8);
}

TEST_CASE("head: the loops above the fold of the upper lid lie one above the other in every face") {
    const HeadLayout& layout = head_layout();
    for (const float sex : {-1.0f, 0.0f, 1.0f}) {
        for (const float age : {0.0f, 1.0f}) {
            for (const float build : {-1.0f, 1.0f}) {
                CAPTURE(sex);
                CAPTURE(age);
                CAPTURE(build);
                const std::vector<Vec3> skin = wrap_head({.age = age, .sex = sex, .build = build});
                const auto find = [&](int loop, float angle) {
                    float nearest = INFINITY;
                    std::uint32_t found = 0;
                    for (std::uint32_t v : left_loops(HeadLoops::Eye, loop, loop)) {
                        const float off = std::abs(layout.vertices[v].angle - angle);
                        if (off < nearest) {
                            nearest = off;
                            found = v;
                        }
                    }
                    return skin[found].y;
                };
                for (const float angle : {1.2f, 1.4f, 1.57f, 1.7f, 1.9f}) {
                    for (int loop = kLidCreaseLoop - 4; loop < kLidLoop; ++loop) {
                        CHECK(find(loop, angle) > find(loop + 1, angle) + 0.04f);  // [cm]
                    }
                }
            }
        }
    }
}

TEST_CASE("head: little light is left in nostrils, and behind the tip of the nose") {
    const HeadLayout& layout = head_layout();
    const auto light = [&](std::uint32_t v) {
        return head_skin_color(layout.vertices[v], wrapped()[v], HeadShape{}).x;
    };
    for (const std::uint32_t v : left_loops(HeadLoops::Nostril, kNostrilRim + 1, kNostrilLoops)) {
        CHECK(light(v) < 0.15f);
    }
    for (const std::uint32_t v : left_loops(HeadLoops::Nostril, kNostrilRim - 1, kNostrilRim - 1)) {
        const float towards_tip = std::sin(layout.vertices[v].angle);
        CHECK((towards_tip > -0.7f || light(v) < 0.25f));
        CHECK((towards_tip < 0.7f || light(v) > 0.8f));
    }
}

TEST_CASE("head: nostrils and what lies behind the lips are cavities, and no other skin is") {
    for (const HeadVertex& vertex : head_layout().vertices) {
        const float relief = head_skin_relief(vertex, wrapped()[0]);
        const bool nostril = vertex.loops == HeadLoops::Nostril && vertex.loop > kNostrilRim;
        const bool mouth = vertex.loops == HeadLoops::Mouth && vertex.loop > kLipLoop + 1;
        CHECK((relief < kSkinCavity) == (nostril || mouth));
        if (nostril && vertex.loop >= kNostrilRim + 3) {
            CHECK(relief == 0);
        }
    }
}

TEST_CASE("head: teeth are a warm white, darker and redder toward the molars and the roots") {
    const HeadPart teeth = make_teeth();
    const auto luminance = [](const Vec4& c) {
        return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
    };
    float front = 0;
    float back = 1;
    for (std::size_t v = 0; v < teeth.mesh.positions.size(); ++v) {
        const Vec4& color = teeth.mesh.colors[v];
        CHECK(color.x >= color.y);
        CHECK(color.y > color.z);
        CHECK(color.w <= kSkinCavity);
        const float z = teeth.mesh.positions[v].z;
        front = z > 10 ? std::max(front, luminance(color)) : front;
        back = z < 7 ? std::min(back, luminance(color)) : back;
        CHECK((z > 7 || color.z < 0.72f * color.x));
    }
    CHECK(front > 0.9f);
    CHECK(back < 0.4f);
}

TEST_CASE("head: hair grows on the scalp alone, its cards lie outside of the skull, roots first") {
    CHECK(scalp_hair_cover({0, 14, 0}) == 1);
    CHECK(scalp_hair_cover({0, 7, 10}) == 0);  // forehead, cheek, neck
    CHECK(scalp_hair_cover({6, 0, 6}) == 0);
    CHECK(scalp_hair_cover({0, -10, -7}) == 0);
    const HeadPart hair = make_scalp_hair(HeadShape{});
    const std::size_t triangles = hair.mesh.indices.size() / 3;
    CHECK(triangles > 3000);
    CHECK(triangles < 12000);
    for (std::size_t v = 0; v < hair.points.size(); ++v) {
        const Vec3& p = hair.points[v].rest;
        CHECK(p.z < 11.5f);
        CHECK(hair.mesh.normals[v].y > -1.01f);
        if (hair.mesh.uvs[v].y > 0) {
            CHECK(head_distance(p, HeadShape{}, 0) > -0.2f);
        } else if (hair.mesh.uvs[v].x == 0) {  // both ends of a root
            CHECK(scalp_hair_cover(0.5f * (p + hair.points[v + 1].rest)) > 0.1f);
        }
        CHECK(head_distance(p, HeadShape{}, 0) < 1.5f);
    }
}

TEST_CASE("head: single hairs line the scalp where its cards end, at the sides and behind, too") {
    const HeadPart hair = make_scalp_hair(HeadShape{});
    int fine = 0;
    int beside = 0;
    for (std::size_t v = 0; v + 1 < hair.points.size(); v += 2) {  // pairs across a card
        const Vec3& a = hair.points[v].rest;
        const Vec3& b = hair.points[v + 1].rest;
        const float width = glm::distance(a, b);  // [cm]
        if (hair.mesh.uvs[v].y == 0) {
            fine += width < 0.07f ? 1 : 0;
            beside += width < 0.07f && a.z < 3 ? 1 : 0;
            CHECK((width < 0.07f || scalp_hair_cover(0.5f * (a + b)) > 0.3f));
        }
    }
    CHECK(fine > 300);
    CHECK(beside > 150);
}

TEST_CASE("head: hair of the temples ends in an even line, cut to the hairline") {
    const HeadPart hair = make_scalp_hair(HeadShape{});
    int tips = 0;
    int low = 0;
    for (std::size_t v = 0; v + 1 < hair.points.size(); v += 2) {
        const Vec3 p = 0.5f * (hair.points[v].rest + hair.points[v + 1].rest);
        const float width = glm::distance(hair.points[v].rest, hair.points[v + 1].rest);
        if (hair.mesh.uvs[v].y < 0.99f || width > 0.3f || p.y > 6 || p.z < 0.3f * std::abs(p.x)) {
            continue;  // no tip of a lock before the ear
        }
        ++tips;
        // 1 cm above it there is hair.
        low += scalp_hair_cover(p + Vec3(0, 1, 0)) < 0.2f ? 1 : 0;
    }
    CHECK(tips > 60);
    CHECK(low < tips / 20);
}

TEST_CASE("head: at weight 1 of the shape age every part is that of seventy years") {
    for (const HeadPartKind part : {HeadPartKind::Skin, HeadPartKind::Hair, HeadPartKind::Scalp}) {
        const MeshData mesh =
            make_head({.part = part, .age = 0.2f, .asymmetry = 0.5f, .grows_old = true});
        const MeshData old = make_head({.part = part, .age = 1, .asymmetry = 0.5f});
        REQUIRE(mesh.morphs.back().name == "age");
        const MorphTarget& age = mesh.morphs.back();
        std::vector<Vec3> positions = mesh.positions;
        float most = 0;
        for (std::size_t i = 0; i < age.vertices.size(); ++i) {
            positions[age.vertices[i]] += age.positions[i];
            most = std::max(most, glm::length(age.positions[i]));
        }
        REQUIRE(positions.size() == old.positions.size());
        float farthest = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            farthest = std::max(farthest, glm::distance(positions[v], old.positions[v]));
        }
        CHECK(farthest < 2e-5f);
        CHECK((part != HeadPartKind::Skin || most > 2e-3f));
    }
}

TEST_CASE("head: evaluating four points at once is bit-identical to evaluating each") {
    constexpr float kStep = 0.01f;
    for (const bool shoulders : {false, true}) {
        const HeadShape shape = {.sex = 0.7f, .build = -0.4f, .shoulders = shoulders};
        std::vector<Vec3> points;
        for (int i = 0; i < 1001; ++i) {  // nor a multiple of four
            const float t = static_cast<float>(i);
            points.emplace_back(
                9 * std::sin(t), 14 * std::cos(0.7f * t) - 4, 12 * std::sin(0.3f * t));
        }
        int different = 0;
        for (const Vec3& p : points) {
            const auto slope = [&](const Vec3& axis) {
                return (head_distance(p + kStep * axis, shape, 1) - head_distance(p, shape, 1))
                       / kStep;
            };
            const Vec3 slopes = {slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
            different += head_gradient(p, shape, 1) == slopes ? 0 : 1;
        }
        CHECK(different == 0);
        std::vector<Vec3> together = points;
        project_forwards(together, shape, 1);
        for (std::size_t i = 0; i < points.size(); ++i) {
            different += project_forwards(points[i], shape, 1) == together[i] ? 0 : 1;
        }
        CHECK(different == 0);
    }
}

TEST_CASE("head: no number of a made mesh is NaN at the ends of all parameters") {
    for (const float end : {0.0f, 1.0f}) {
        const MeshData mesh =
            make_head({.age = end, .sex = 2 * end - 1, .build = 1 - 2 * end, .asymmetry = end});
        CHECK(std::all_of(mesh.positions.begin(), mesh.positions.end(), is_finite<3>));
        CHECK(std::all_of(mesh.normals.begin(), mesh.normals.end(), is_finite<3>));
        CHECK(mesh.regions.size() == 15);
    }
}

TEST_CASE("head: pores are deepest on the nose, shallower on cheek and forehead, and not on lids") {
    const auto relief = [](const Vec3& p) { return head_skin_relief(HeadVertex{}, p); };
    const float nose = relief({0, 0.5f, 12});
    const float cheek = relief({2.8f, 0.3f, 9.7f});
    const float forehead = relief({0, 7.5f, 10.1f});
    CHECK(nose == 1);
    CHECK(cheek < 0.9f * nose);
    CHECK(forehead < 0.9f * cheek);
    CHECK(relief({6.8f, 4, 3}) < 0.7f * forehead);
    const HeadVertex lid{.loops = HeadLoops::Eye, .loop = kLidCreaseLoop - 2};
    CHECK(head_skin_relief(lid, {2.8f, 0.3f, 9.7f}) < 0.5f * forehead);
    const MeshData mesh = make_head({});
    CHECK(std::ranges::max(mesh.colors, {}, &Vec4::w).w == 1);
}

TEST_CASE("head: no vertex of the upper lip has the position of one of the lower lip") {
    const auto ring = mouth_loop(kLipLoop);
    for (std::size_t k = 1; k < ring.size() / 2; ++k) {
        const float gap = wrapped()[ring[k]].y - wrapped()[ring[ring.size() - k]].y;
        CHECK(gap > 1e-4f);  // [cm]: normals are those of all that meets at a position
        CHECK(gap < 1e-3f);
    }
}

}  // namespace
}  // namespace limn::head_test
