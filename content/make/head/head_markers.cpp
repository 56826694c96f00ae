#include "content/make/head/head_markers.h"

#include "content/bake/delaunay.h"
#include "content/make/head/head_layout.h"
#include "ecs/base/check.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace limn {

namespace {

constexpr int kEnd = -1000;

/// Markers on a row of the grid, left half.
struct GridRow {
    int row;
    std::array<int, 8> columns;  ///< up to kEnd
};

constexpr GridRow kGrid[] = {
    {-12, {48, kEnd}},  // the middle of the crown
    {0, {0, 16, 32, 48, kEnd}},
    {10, {0, 10, 22, 35, 48, kEnd}},  // hairline
    {15, {0, 6, 12, 18, kEnd}},
    {20, {0, 4, 10, 16, 22, kEnd}},
    {22, {2, 7, 13, kEnd}},
    {24, {0, 4, 10, 16, 22, 40, kEnd}},  // brows, the border around the eyes
    {27, {0, 29, 34, kEnd}},             // down to row 43: around the ears
    {29, {2, 4, 16, 22, kEnd}},
    {31, {0, kEnd}},
    {34, {0, 2, 4, 10, 16, 22, kEnd}},
    {35, {29, 34, 48, kEnd}},
    {37, {0, 3, kEnd}},
    {39, {7, 11, 16, kEnd}},
    {40, {0, kEnd}},
    {43, {0, 3, 7, 29, 34, kEnd}},
    {44, {0, 6, 11, 16, 22, kEnd}},  // down to row 56: around the mouth
    {50, {11, 16, 24, 31, kEnd}},
    {56, {0, 6, 11, 17, 25, 31, 38, kEnd}},
    {60, {0, 5, 11, 18, 30, kEnd}},  // chin
    {64, {0, 8, 16, 25, 48, kEnd}},
    {68, {0, 7, 14, 22, 30, kEnd}},
    {73, {0, 9, 18, 27, 36, kEnd}},
    {78, {0, 8, 16, 24, 32, 48, kEnd}},
    {86, {0, 8, 16, 24, 32, 40, 48, kEnd}},  // end of the neck
};

/// Markers on a loop, left half, by angle [degrees].
struct LoopRing {
    std::string_view name;
    HeadLoops loops;
    int loop;
    std::array<int, 13> angles;  ///< up to kEnd
};

constexpr LoopRing kLoopRings[] = {
    {"lid", HeadLoops::Eye, 4, {0, 41, 90, 139, 180, 221, 270, 319, kEnd}},
    {"lid",
     HeadLoops::Eye,
     kLidLoop,
     {0, 25, 57, 90, 123, 155, 180, 205, 237, 270, 303, 335, kEnd}},
    {"lid", HeadLoops::Eye, kLidLoop + 2, {0, 57, 90, 123, 180, 237, 270, 303, kEnd}},
    {"lid", HeadLoops::Eye, kEyeLoops, {0, 90, 180, 270, kEnd}},
    {"nostril", HeadLoops::Nostril, kNostrilRim, {0, 60, 120, 180, 240, 300, kEnd}},
    {"mouth", HeadLoops::Mouth, 4, {270, 302, 328, 0, 32, 58, 90, kEnd}},
    {"mouth", HeadLoops::Mouth, 7, {270, 302, 328, 0, 32, 58, 90, kEnd}},
    {"mouth", HeadLoops::Mouth, 9, {270, 286, 302, 328, 344, 0, 16, 32, 58, 74, 90, kEnd}},
    {"mouth", HeadLoops::Mouth, kLipLoop, {270, 286, 302, 328, 344, 0, 16, 32, 58, 74, 90, kEnd}},
    {"mouth",
     HeadLoops::Mouth,
     kLipLoop + 1,
     {270, 286, 302, 328, 344, 0, 16, 32, 58, 74, 90, kEnd}},
    {"mouth", HeadLoops::Mouth, kLipLoop + 3, {270, 302, 0, 58, 90, kEnd}},
    {"mouth", HeadLoops::Mouth, kLipLoop + 5, {270, 0, 90, kEnd}},
    {"ear", HeadLoops::Ear, 8, {0, 90, 180, 270, kEnd}},
    {"ear", HeadLoops::Ear, 20, {0, 90, 180, 270, kEnd}},
};

/// The vertex of the left half, or the middle, that `distance` of is the least.
template <typename Distance>
std::uint32_t nearest_vertex(const HeadLayout& layout, const Distance& distance) {
    float nearest = INFINITY;
    std::uint32_t found = 0;
    for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
        const float to = distance(layout.vertices[v]);
        if (to < nearest) {
            nearest = to;
            found = v;
        }
    }
    LIMN_CHECK(nearest < INFINITY);
    return found;
}

std::uint32_t grid_vertex(const HeadLayout& layout, int column, int row) {
    return nearest_vertex(layout, [&](const HeadVertex& vertex) {
        const float turns = (vertex.chart.x - static_cast<float>(column)) / kHeadColumns;
        const bool here = vertex.loops == HeadLoops::None
                          && std::abs(turns - std::round(turns)) < 1e-4f
                          && std::abs(vertex.chart.y - static_cast<float>(row)) < 1e-3f;
        return here ? 0.0f : INFINITY;
    });
}

std::uint32_t ring_vertex(const HeadLayout& layout, const LoopRing& ring, int angle) {
    return nearest_vertex(layout, [&](const HeadVertex& vertex) {
        const bool here = vertex.loops == ring.loops && vertex.loop == ring.loop && vertex.left;
        const float turn = radians(static_cast<float>(angle)) - vertex.angle;
        return here ? std::abs(std::remainder(turn, 2 * kPi)) : INFINITY;
    });
}

class MarkerBuilder {
  public:
    HeadMarkers build() {
        for (const GridRow& row : kGrid) {
            for (std::size_t i = 0; row.columns[i] != kEnd; ++i) {
                const int column = row.columns[i];
                add(fmt::format("skin{}_{}", row.row, column),
                    grid_vertex(layout_, column, row.row), Vec2(column, row.row));
            }
        }
        for (const LoopRing& ring : kLoopRings) {
            for (std::size_t i = 0; ring.angles[i] != kEnd; ++i) {
                const std::uint32_t v = ring_vertex(layout_, ring, ring.angles[i]);
                add(fmt::format("{}{}_{}", ring.name, ring.loop, ring.angles[i]), v,
                    layout_.vertices[v].chart);
            }
        }
        add_triangles();
        return std::move(markers_);
    }

  private:
    /// Of the left half; on x = 0 they are in the middle.
    void add(const std::string& name, std::uint32_t vertex, const Vec2& chart) {
        const bool middle = layout_.mirror[vertex] == vertex;
        markers_.names.push_back(name + (middle ? "_M" : "_L"));
        markers_.vertices.push_back(vertex);
        markers_.charts.push_back(chart);
    }

    /// Those of the left half, and their mirror images.
    void add_triangles() {
        std::vector<glm::dvec2> flat;
        for (const Vec2& chart : markers_.charts) {
            flat.emplace_back(chart.x, -chart.y);
        }
        const std::vector<std::uint32_t> left = triangulate_points(flat);
        const std::vector<std::uint32_t> mirrored = add_mirror_images();
        for (std::size_t i = 0; i < left.size(); i += 3) {
            markers_.indices.insert(markers_.indices.end(), {left[i], left[i + 1], left[i + 2]});
            markers_.indices.insert(
                markers_.indices.end(),
                {mirrored[left[i]], mirrored[left[i + 2]], mirrored[left[i + 1]]});
        }
    }

    /// Of each vertex of the left half its mirror image.
    std::vector<std::uint32_t> add_mirror_images() {
        std::vector<std::uint32_t> mirrored;
        const std::size_t count = markers_.names.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (markers_.charts[i].x == 0) {
                mirrored.push_back(static_cast<std::uint32_t>(i));
                continue;
            }
            mirrored.push_back(static_cast<std::uint32_t>(markers_.names.size()));
            std::string name = markers_.names[i];
            if (name.back() == 'L') {
                name.back() = 'R';
            }
            markers_.names.push_back(std::move(name));
            markers_.vertices.push_back(layout_.mirror[markers_.vertices[i]]);
            markers_.charts.push_back(markers_.charts[i] * Vec2(-1, 1));
        }
        return mirrored;
    }

    const HeadLayout& layout_ = head_layout();
    HeadMarkers markers_;
};

}  // namespace

const HeadMarkers& head_markers() {
    static const HeadMarkers markers = MarkerBuilder().build();
    return markers;
}

}  // namespace limn
