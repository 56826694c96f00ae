#include "content/make/head/head_layout.h"

#include "content/make/head/head_shoulders.h"
#include "content/make/head/head_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limn {

namespace {

/// A row of the grid: where it crosses the midline of the face, the side and the back [cm].
struct KeyRow {
    float row;
    Vec2 front;  ///< y, z
    Vec3 side;
    Vec2 back;  ///< y, z
};

constexpr std::array<KeyRow, 9> kKeyRows = {{
    {0, {13.6f, 6.2f}, {5.2f, 13.2f, -0.5f}, {12.8f, -6.3f}},    // rim of the crown
    {10, {9.6f, 9.2f}, {7.5f, 9.4f, 0}, {8.5f, -9.3f}},          // hairline
    {24, {5.2f, 10.0f}, {7.6f, 4.6f, 0}, {3.8f, -9.3f}},         // brows
    {41, {-0.6f, 10.2f}, {6.9f, -0.7f, 0}, {-0.7f, -8.2f}},      // base of the nose
    {50, {-3.3f, 10.4f}, {6.5f, -2.9f, 0}, {-3, -7.4f}},         // lips
    {60, {-6.6f, 10.2f}, {5.8f, -5.4f, -0.4f}, {-5.4f, -7.3f}},  // chin
    {64, {-7.7f, 8.8f}, {5.6f, -6.7f, -0.8f}, {-6.8f, -7.4f}},   // under the chin
    {71, {-8.5f, 4.6f}, {5.6f, -8.8f, -1.8f}, {-9.2f, -7.7f}},   // throat
    {86, {-14.5f, 2.7f}, {6, -14.5f, -2.9f}, {-14.5f, -8.4f}},   // end of the neck
}};

template <typename T>
T cubic(const T& a, const T& b, const T& c, const T& d, float t) {
    return b
           + 0.5f * t
                 * (c - a
                    + t * (2.0f * a - 5.0f * b + 4.0f * c - d + t * (3.0f * (b - c) + d - a)));
}

KeyRow row_at(float row) {
    std::size_t i = 0;
    while (i + 2 < kKeyRows.size() && kKeyRows[i + 1].row <= row) {
        ++i;
    }
    const KeyRow& a = kKeyRows[i == 0 ? 0 : i - 1];
    const KeyRow& b = kKeyRows[i];
    const KeyRow& c = kKeyRows[i + 1];
    const KeyRow& d = kKeyRows[std::min(i + 2, kKeyRows.size() - 1)];
    const float t = (row - b.row) / (c.row - b.row);
    return {
        row, cubic(a.front, b.front, c.front, d.front, t), cubic(a.side, b.side, c.side, d.side, t),
        cubic(a.back, b.back, c.back, d.back, t)};
}

float even_angle(int column) {
    return 2 * kPi * static_cast<float>(column) / static_cast<float>(kHeadColumns);
}

Vec3 grid_point(int column, int row) {
    const float turn = even_angle(column);
    const float angle = turn - 0.45f * std::sin(turn);  // columns are closer in front
    const KeyRow key = row_at(static_cast<float>(row));
    const float c = std::cos(angle);
    const Vec2 end = c > 0 ? key.front : key.back;
    const Vec2 side = {key.side.y, key.side.z};
    return {
        key.side.x * std::sin(angle), glm::mix(side.x, end.x, c * c),
        glm::mix(side.y, end.y, std::abs(c))};
}

/// A block of the grid that loops replace.
struct Block {
    HeadLoops loops;
    int column0, column1, row0, row1;  ///< corners
    int count;                         ///< of loops
};

constexpr std::array<Block, 7> kBlocks = {{
    {HeadLoops::Eye, 4, 16, 24, 34, kEyeLoops},
    {HeadLoops::Eye, -16, -4, 24, 34, kEyeLoops},
    {HeadLoops::Nostril, 1, 6, 38, 42, kNostrilLoops},
    {HeadLoops::Nostril, -6, -1, 38, 42, kNostrilLoops},
    {HeadLoops::Mouth, -11, 11, 44, 56, kMouthLoops},
    {HeadLoops::Ear, 29, 34, 27, 43, kEarLoops},
    {HeadLoops::Ear, -34, -29, 27, 43, kEarLoops},
}};

/// The loop along the edge of the opening, whose position is given, or 0.
int edge_loop(HeadLoops loops) {
    switch (loops) {
    case HeadLoops::Eye:
        return kLidLoop;
    case HeadLoops::Nostril:
        return kNostrilRim;
    case HeadLoops::Mouth:
        return kLipLoop;
    default:
        return 0;
    }
}

Vec3 edge_point(HeadLoops loops, float angle, bool left) {
    if (loops == HeadLoops::Mouth) {
        return lip_line(angle);
    }
    const Vec3 point = loops == HeadLoops::Nostril ? nostril_rim(angle) : lid_margin(angle);
    return point * Vec3(left ? 1 : -1, 1, 1);
}

bool inside(const Block& block, int column, int row, int margin) {
    return column >= block.column0 + margin && column <= block.column1 - margin
           && row >= block.row0 + margin && row <= block.row1 - margin;
}

class Builder {
  public:
    HeadLayout build(bool shoulders) {
        for (int row = 0; row <= kHeadRows; ++row) {
            for (int column = -kHeadColumns / 2; column < kHeadColumns / 2; ++column) {
                const bool removed =
                    std::any_of(kBlocks.begin(), kBlocks.end(), [&](const Block& block) {
                        return inside(block, column, row, 1);
                    });
                if (!removed) {
                    HeadVertex vertex;
                    vertex.start = grid_point(column, row);
                    vertex.chart = {column, row};
                    vertex.left = column >= 0;
                    grid_[{column, row}] = add(vertex);
                }
            }
        }
        add_grid_quads(0, kHeadRows);
        add_cap();
        for (const Block& block : kBlocks) {
            add_loops(block);
        }
        if (shoulders) {
            add_shoulders();
        }
        find_mirror();
        return std::move(layout_);
    }

  private:
    std::uint32_t add(const HeadVertex& vertex) {
        layout_.vertices.push_back(vertex);
        return static_cast<std::uint32_t>(layout_.vertices.size() - 1);
    }

    std::uint32_t at(int column, int row) const {
        const int half = kHeadColumns / 2;
        const int wrapped = (column + half + kHeadColumns) % kHeadColumns - half;
        return grid_.at({wrapped, row});
    }

    void add_grid_quads(int first, int end) {
        for (int row = first; row < end; ++row) {
            for (int column = -kHeadColumns / 2; column < kHeadColumns / 2; ++column) {
                const bool removed =
                    std::any_of(kBlocks.begin(), kBlocks.end(), [&](const Block& block) {
                        return inside(block, column, row, 0)
                               && inside(block, column + 1, row + 1, 0);
                    });
                if (!removed) {
                    layout_.quads.push_back(
                        {at(column, row), at(column, row + 1), at(column + 1, row + 1),
                         at(column + 1, row)});
                }
            }
        }
    }

    void add_shoulders() {
        layout_.rows = kHeadRows + kShoulderRows;
        for (int row = kHeadRows + 1; row <= layout_.rows; ++row) {
            for (int column = -kHeadColumns / 2; column < kHeadColumns / 2; ++column) {
                HeadVertex vertex;
                vertex.start = shoulder_start(
                    layout_.vertices[at(column, kHeadRows)].start, even_angle(column),
                    static_cast<float>(row - kHeadRows) / kShoulderRows);
                vertex.chart = {column, row};
                vertex.left = column >= 0;
                grid_[{column, row}] = add(vertex);
            }
        }
        add_grid_quads(kHeadRows, layout_.rows);
    }

    /// A square grid whose border is row 0; +i runs to the left, +j to the back.
    void add_cap() {
        constexpr int kSide = kHeadColumns / 4;
        constexpr int kHalf = kSide / 2;
        std::array<std::array<std::uint32_t, kSide + 1>, kSide + 1> cap{};
        for (int k = 0; k <= kSide; ++k) {
            cap[k][0] = at(k - kHalf, 0);
            cap[kSide][k] = at(kHalf + k, 0);
            cap[k][kSide] = at(3 * kHalf + kSide - k, 0);
            cap[0][k] = at(-kHalf - k, 0);
        }
        const auto start = [&](int i, int j) { return layout_.vertices[cap[i][j]].start; };
        for (int j = 1; j < kSide; ++j) {
            for (int i = 1; i < kSide; ++i) {
                const float s = static_cast<float>(i) / kSide;
                const float t = static_cast<float>(j) / kSide;
                const Vec3 corners = glm::mix(
                    glm::mix(start(0, 0), start(kSide, 0), s),
                    glm::mix(start(0, kSide), start(kSide, kSide), s), t);
                HeadVertex vertex;
                vertex.start = glm::mix(start(0, j), start(kSide, j), s)
                               + glm::mix(start(i, 0), start(i, kSide), t) - corners;
                vertex.start.y += 8 * s * (1 - s) * 4 * t * (1 - t) * 0.25f;
                const Vec2 from = {static_cast<float>(i - kHalf), static_cast<float>(j - kHalf)};
                const float ring = std::max(std::abs(from.x), std::abs(from.y));
                vertex.chart = {
                    std::atan2(from.x, -from.y) / kPi * (kHeadColumns / 2), ring - kHalf};
                vertex.left = i >= kHalf;
                cap[i][j] = add(vertex);
            }
        }
        for (int j = 0; j < kSide; ++j) {
            for (int i = 0; i < kSide; ++i) {
                layout_.quads.push_back(
                    {cap[i][j], cap[i + 1][j], cap[i + 1][j + 1], cap[i][j + 1]});
            }
        }
    }

    void add_loops(const Block& block) {
        // The border counter-clockwise, viewed from outside, from the center of its lateral side;
        // on the right side clockwise, so that angles are those of the mirror image.
        const bool left = block.column0 + block.column1 >= 0;  // the mouth counts as left
        const int width = block.column1 - block.column0;
        const int height = block.row1 - block.row0;
        const int count = 2 * (width + height);
        std::vector<std::uint32_t> border;
        for (int k = 0; k < count; ++k) {
            int s = (k + height / 2) % count;  // from the lower lateral corner upwards
            int column = 0;
            int row = 0;
            if (s < height) {
                column = width;
                row = height - s;
            } else if ((s -= height) < width) {
                column = width - s;
            } else if ((s -= width) < height) {
                row = s;
            } else {
                column = s - height;
                row = height;
            }
            border.push_back(
                at(left ? block.column0 + column : block.column1 - column, block.row0 + row));
        }
        Vec2 chart_center = {
            0.5f * static_cast<float>(block.column0 + block.column1),
            0.5f * static_cast<float>(block.row0 + block.row1)};
        Vec3 center = Vec3(0);
        for (const std::uint32_t v : border) {
            center += layout_.vertices[v].start / static_cast<float>(count);
        }
        std::vector<std::uint32_t> outer = border;
        for (int loop = 1; loop <= block.count; ++loop) {
            const float inwards = static_cast<float>(loop) / static_cast<float>(block.count + 1);
            std::vector<std::uint32_t> inner;
            for (int k = 0; k < count; ++k) {
                HeadVertex vertex;
                vertex.start = glm::mix(layout_.vertices[border[k]].start, center, inwards);
                vertex.chart = glm::mix(layout_.vertices[border[k]].chart, chart_center, inwards);
                vertex.loops = block.loops;
                vertex.loop = static_cast<std::int16_t>(loop);
                vertex.angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(count);
                const int edge = edge_loop(block.loops);
                if (loop < edge) {  // evenly between the border and the edge of the opening
                    vertex.start = glm::mix(
                        layout_.vertices[border[k]].start,
                        edge_point(block.loops, vertex.angle, left),
                        static_cast<float>(loop) / static_cast<float>(edge));
                }
                vertex.left = block.loops == HeadLoops::Mouth
                                  ? k <= count / 4 || k >= count - count / 4
                                  : left;
                inner.push_back(add(vertex));
            }
            join(outer, inner, left);
            outer = inner;
        }
        // Closed by quads across the last loop, between its upper and its lower half.
        for (int k = 0; k + 1 < count / 2; ++k) {
            add_quad(outer[k], outer[k + 1], outer[count - k - 2], outer[count - k - 1], left);
        }
    }

    void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool left) {
        layout_.quads.push_back(
            left ? std::array<std::uint32_t, 4>{a, b, c, d}
                 : std::array<std::uint32_t, 4>{d, c, b, a});
    }

    void join(
        const std::vector<std::uint32_t>& outer, const std::vector<std::uint32_t>& inner,
        bool left) {
        for (std::size_t k = 0; k < outer.size(); ++k) {
            const std::size_t next = (k + 1) % outer.size();
            add_quad(outer[k], outer[next], inner[next], inner[k], left);
        }
    }

    void find_mirror() {
        using VertexKey = std::array<long, 4>;  // rounded position and loop
        std::map<VertexKey, std::uint32_t> indices;
        const auto key_of = [](const HeadVertex& v) {
            return VertexKey{
                std::lround(v.start.x * 1000), std::lround(v.start.y * 1000),
                std::lround(v.start.z * 1000), v.loop};
        };
        for (std::uint32_t i = 0; i < layout_.vertices.size(); ++i) {
            indices[key_of(layout_.vertices[i])] = i;
        }
        for (std::uint32_t i = 0; i < layout_.vertices.size(); ++i) {
            const VertexKey key = key_of(layout_.vertices[i]);
            std::uint32_t found = i;
            for (int k = 0; k < 27; ++k) {  // it may be rounded differently
                const auto other = indices.find(
                    {-key[0] + k % 3 - 1, key[1] + k / 3 % 3 - 1, key[2] + k / 9 - 1, key[3]});
                found = other == indices.end() ? found : other->second;
            }
            layout_.mirror.push_back(found);
        }
    }

    HeadLayout layout_;
    std::map<std::array<int, 2>, std::uint32_t> grid_;
};

}  // namespace

const HeadLayout& head_layout(bool shoulders) {
    if (shoulders) {
        static const HeadLayout with = Builder().build(true);
        return with;
    }
    static const HeadLayout layout = Builder().build(false);
    return layout;
}

}  // namespace limn
