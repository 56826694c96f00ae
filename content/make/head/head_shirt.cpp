#include "content/bake/tangents.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_parts.h"
#include "content/make/head/head_shoulders.h"
#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace limn {

namespace {

constexpr float kLoose = 0.3f;   ///< distance from the skin [cm]
constexpr int kRows = 34;        ///< of the grid from the neckline to the end of the shoulders
constexpr int kHangingRows = 6;  ///< of the grid below
constexpr int kAllRows = kRows + kHangingRows;
constexpr float kHanging = 5;      ///< [cm]
constexpr int kSmoothRounds = 40;  ///< so that it spans hollows
constexpr int kBodyRows = 30;      ///< of vertices below the collar

/// A row of the collar: a band that folds over the neckline, and its seam.
struct CollarRow {
    float down;   ///< from the neckline [cm]; < 0: beyond it
    float raise;  ///< from the cloth, away from the skin [cm]
};
constexpr std::array<CollarRow, 13> kCollar = {{
    {0.3f, -0.34f},
    {0, -0.34f},
    {-0.25f, -0.3f},
    {-0.42f, -0.16f},
    {-0.45f, 0},
    {-0.3f, 0.1f},
    {0, 0.13f},
    {0.5f, 0.13f},
    {0.9f, 0.11f},
    {1.1f, 0.06f},
    {1.2f, -0.05f},
    {1.35f, -0.01f},
    {1.8f, 0},
}};

constexpr std::uint32_t kRowCount = kCollar.size() + kBodyRows + 1;  ///< of vertices

/// > 0 above the neckline: wide, lower in front.
float above_neckline(const Vec3& p) {
    const float back = p.z + 9.5f;
    return p.y + 13.2f + 0.29f * back + 0.031f * back * (back - 5.5f);
}

/// A column of the skin's grid from the neck down.
std::vector<std::uint32_t> column_vertices(int column) {
    const HeadLayout& layout = head_layout(true);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < layout.vertices.size(); ++v) {
        const HeadVertex& vertex = layout.vertices[v];
        if (vertex.loops == HeadLoops::None && vertex.chart.x == static_cast<float>(column)
            && vertex.chart.y >= kHeadRows / 2) {
            vertices.push_back(v);
        }
    }
    return vertices;
}

/// Positions of all columns, from the back to the left.
std::vector<std::vector<Vec3>> skin_columns(const std::vector<Vec3>& skin) {
    std::vector<std::vector<Vec3>> lines(kHeadColumns);
    for (int column = 0; column < kHeadColumns; ++column) {
        for (const std::uint32_t v : column_vertices(column - kHeadColumns / 2)) {
            lines[column].push_back(skin[v]);
        }
    }
    return lines;
}

/// Arc length of a line from its first point to each point.
std::vector<float> lengths_along(const std::vector<Vec3>& line) {
    std::vector<float> lengths = {0};
    for (std::size_t i = 1; i < line.size(); ++i) {
        lengths.push_back(lengths.back() + glm::distance(line[i - 1], line[i]));
    }
    return lengths;
}

Vec3 point_along(const std::vector<Vec3>& line, const std::vector<float>& lengths, float at) {
    std::size_t i = 1;
    while (i + 1 < line.size() && lengths[i] < at) {
        ++i;
    }
    const float step = std::max(lengths[i] - lengths[i - 1], 1e-6f);
    return glm::mix(line[i - 1], line[i], glm::clamp((at - lengths[i - 1]) / step, 0.0f, 1.0f));
}

/// Arc length at which a line crosses the neckline.
float neckline_along(const std::vector<Vec3>& line, const std::vector<float>& lengths) {
    std::size_t i = 1;
    while (i + 1 < line.size() && above_neckline(line[i]) > 0) {
        ++i;
    }
    const float before = above_neckline(line[i - 1]);
    const float here = above_neckline(line[i]);
    return glm::mix(lengths[i - 1], lengths[i], before / (before - here));
}

/// Smooths the neckline where it crosses bones.
void smooth_around(std::vector<float>& values) {
    constexpr int kRounds = 60;
    const std::size_t count = values.size();
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<float> before = values;
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = 0.5f * before[i]
                        + 0.25f * (before[(i + 1) % count] + before[(i + count - 1) % count]);
        }
    }
}

/// Arc length at which each column crosses the neckline.
std::vector<float> necklines(const std::vector<std::vector<Vec3>>& lines) {
    std::vector<float> starts;
    for (const std::vector<Vec3>& line : lines) {
        starts.push_back(neckline_along(line, lengths_along(line)));
    }
    smooth_around(starts);
    return starts;
}

/// Points of the shirt before it is sewn: rows downwards for each column of the skin.
struct ShirtGrid {
    std::vector<Vec3> points;

    Vec3& at(int row, int column) {
        return points[row * kHeadColumns + (column + kHeadColumns) % kHeadColumns];
    }
};

/// Spans hollows like tight cloth: smooth, but nowhere closer to the skin than kLoose.
void smooth(ShirtGrid& grid, const HeadShape& shape) {
    for (int round = 0; round < kSmoothRounds; ++round) {
        ShirtGrid before = grid;
        parallel_for(kAllRows - 1, 4, [&](std::size_t begin, std::size_t end) {
            for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
                for (int column = 0; column < kHeadColumns; ++column) {
                    const Vec3 beside =
                        0.5f * (before.at(row, column - 1) + before.at(row, column + 1));
                    const Vec3 mean =
                        row == 0
                            ? beside
                            : 0.5f * beside
                                  + 0.25f
                                        * (before.at(row - 1, column) + before.at(row + 1, column));
                    Vec3 p = glm::mix(before.at(row, column), mean, 0.5f);
                    const Vec3 out = head_gradient(p, shape, 1);
                    p += std::max(kLoose - head_distance(p, shape, 1), 0.0f) * glm::normalize(out);
                    grid.at(row, column) = p;
                }
            }
        });
    }
}

/// On the skin below a smooth neckline, and straight down from its end; then smoothed.
ShirtGrid make_grid(const HeadShape& shape) {
    const std::vector<std::vector<Vec3>> lines = skin_columns(wrap_head(shape));
    const std::vector<float> starts = necklines(lines);
    ShirtGrid grid;
    grid.points.resize(kAllRows * kHeadColumns);
    for (int column = 0; column < kHeadColumns; ++column) {
        const std::vector<Vec3>& line = lines[column];
        const std::vector<float> lengths = lengths_along(line);
        for (int row = 0; row < kRows; ++row) {
            const float down = static_cast<float>(row) / (kRows - 1);
            grid.at(row, column) =
                point_along(line, lengths, glm::mix(starts[column], lengths.back(), down));
        }
        const Vec3 out = head_gradient(line.back(), shape, 1);
        const Vec3 end = line.back() + kLoose * normalize_or({out.x, 0, out.z}, Vec3(0));
        for (int row = 1; row <= kHangingRows; ++row) {
            const float down = static_cast<float>(row) / kHangingRows;
            grid.at(kRows - 1 + row, column) = end - Vec3(0, kHanging * down, 0);
        }
    }
    smooth(grid, shape);
    return grid;
}

/// A column of vertices, from the fold of the collar to the hem, and further to close the shirt
/// below.
std::vector<Vec3> sew_column(ShirtGrid& grid, int column, const HeadShape& shape) {
    std::vector<Vec3> cloth;
    for (int row = 0; row < kAllRows; ++row) {
        cloth.push_back(grid.at(row, column));
    }
    const std::vector<float> lengths = lengths_along(cloth);
    const Vec3 up = glm::normalize(cloth[0] - cloth[1]);
    const Vec3 across = grid.at(0, column + 1) - grid.at(0, column - 1);
    const Vec3 out = glm::normalize(glm::cross(across, up));
    std::vector<Vec3> sewn;
    for (const CollarRow& row : kCollar) {
        const Vec3 p =
            row.down < 0 ? cloth[0] - row.down * up : point_along(cloth, lengths, row.down);
        sewn.push_back(p + row.raise * out);
    }
    sewn[0] = project_to_head(sewn[0], shape, 1);
    for (int row = 1; row <= kBodyRows; ++row) {
        const float down = static_cast<float>(row) / kBodyRows;
        sewn.push_back(
            point_along(cloth, lengths, glm::mix(kCollar.back().down, lengths.back(), down)));
    }
    sewn.push_back(glm::mix(cloth.back(), Vec3(0, cloth.back().y, -3), 0.6f));
    return sewn;
}

}  // namespace

std::vector<bool> find_covered_skin(const std::vector<Vec3>& skin) {
    constexpr float kMargin = 2;  // [cm], more than the skin there moves with the head
    LIMN_CHECK(skin.size() == head_layout(true).vertices.size());
    const std::vector<float> starts = necklines(skin_columns(skin));
    std::vector<bool> covered(skin.size(), false);
    for (int column = 0; column < kHeadColumns; ++column) {
        const std::vector<std::uint32_t> vertices = column_vertices(column - kHeadColumns / 2);
        float length = 0;
        for (std::size_t i = 1; i < vertices.size(); ++i) {
            length += glm::distance(skin[vertices[i - 1]], skin[vertices[i]]);
            covered[vertices[i]] = length > starts[column] + kMargin;
        }
    }
    return covered;
}

HeadPart make_shirt(const HeadShape& shape) {
    ShirtGrid grid = make_grid(shape);
    std::vector<std::vector<Vec3>> columns;
    for (int column = 0; column <= kHeadColumns; ++column) {  // the first again
        columns.push_back(sew_column(grid, column, shape));
    }
    HeadPart part;
    part.mesh.name = "shirt";
    for (std::uint32_t row = 0; row < kRowCount; ++row) {
        for (std::size_t column = 0; column < columns.size(); ++column) {
            HeadPoint point;
            point.rest = columns[column][row];
            part.points.push_back(point);
            part.mesh.positions.push_back(point.rest);
            part.mesh.uvs.emplace_back(
                static_cast<float>(column) / kHeadColumns, static_cast<float>(row) / kRowCount);
            part.mesh.colors.emplace_back(1, 1, 1, 1);
        }
    }
    append_grid(part.mesh, kRowCount, kHeadColumns + 1, false, true);
    generate_normals(part.mesh);
    return part;
}

}  // namespace limn
