#include "content/bake/furrow_trace.h"

#include "ecs/base/check.h"
#include "ecs/base/repeatable_math.h"

#include <algorithm>
#include <cstddef>

// Techniques: wrinkle.furrow.functions, wrinkle.furrow.heightfield, wrinkle.furrow.topography,
//     wrinkle.furrow.trace

namespace limn {
namespace {

constexpr float kMaxTracedMagnitude = 2.0f;
constexpr float kEdgeTolerance = 1e-3f;  // overlap of triangles that share an edge [px]
constexpr float kStill = 1e-4f;          // magnitude that counts as zero
constexpr float kFarFromTrace = 1e30f;   // beyond the end of every segment [px]

float cross(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

bool covers(const FurrowTriangle& triangle, const Vec2& p) {
    for (int i = 0; i < 3; ++i) {
        const Vec2 edge = triangle.corner[(i + 1) % 3] - triangle.corner[i];
        const float slack = kEdgeTolerance * (std::abs(edge.x) + std::abs(edge.y));
        if (cross(edge, p - triangle.corner[i]) < -slack) {
            return false;
        }
    }
    return true;
}

/// `i` within an image that repeats; rarely more than one step away.
int wrapped_angle(int i, int size) {
    while (i < 0) {
        i += size;
    }
    while (i >= size) {
        i -= size;
    }
    return i;
}

/// The image on which furrows are drawn.
struct Canvas {
    const FurrowMap& map;
    const std::vector<std::int32_t>& cover;
    FurrowDrawing& drawing;

    /// Index of the pixel, or -1 beyond the borders of the image.
    [[nodiscard]] int pixel(IVec2 at) const {
        const IVec2 size = map.size;
        if (map.wrap_s) {
            at.x = wrapped_angle(at.x, size.x);
        }
        if (map.wrap_t) {
            at.y = wrapped_angle(at.y, size.y);
        }
        const bool inside = at.x >= 0 && at.x < size.x && at.y >= 0 && at.y < size.y;
        return inside ? at.y * size.x + at.x : -1;
    }
    [[nodiscard]] bool is_obstacle(const IVec2& at, std::uint32_t furrow) const {
        const int index = pixel(at);
        if (index < 0 || cover[static_cast<std::size_t>(index)] < 0) {
            return true;
        }
        const std::uint32_t owner = drawing.cells[static_cast<std::size_t>(index)] & ~kFurrowBand;
        return owner != 0 && owner != furrow;
    }
    void own(const IVec2& at, std::uint32_t furrow) {
        const int index = pixel(at);
        if (index >= 0) {
            std::uint32_t& cell = drawing.cells[static_cast<std::size_t>(index)];
            cell |= (cell & ~kFurrowBand) == 0 ? furrow | kFurrowBand : 0;
        }
    }
};

IVec2 cell_of(const Vec2& p) {
    IVec2 cell(p);  // toward zero
    cell.x -= static_cast<float>(cell.x) > p.x ? 1 : 0;
    cell.y -= static_cast<float>(cell.y) > p.y ? 1 : 0;
    return cell;
}

/// Distance along `direction` to the first line between pixels across an axis, and between lines.
struct Crossings {
    float first = kFarFromTrace;
    float step = kFarFromTrace;
};

Crossings crossings(float at, int cell, float direction) {
    if (std::abs(direction) < 1e-6f) {
        return {};
    }
    const float inverse = repeatable_reciprocal(direction);
    const float edge = static_cast<float>(direction > 0 ? cell + 1 : cell) - at;
    return {edge * inverse, std::abs(inverse)};
}

/// Traverses the pixels along a segment and claims them, up to the first obstacle. Returns the
/// distance to it, or `length`.
float walk(
    Canvas& canvas, const Vec2& from, const Vec2& direction, float length, std::uint32_t furrow,
    bool& met) {
    const IVec2 start = cell_of(from);
    const IVec2 side(direction.x > 0 ? 1 : -1, direction.y > 0 ? 1 : -1);
    const Crossings across_x = crossings(from.x, start.x, direction.x);
    const Crossings across_y = crossings(from.y, start.y, direction.y);
    IVec2 cell = start;
    int steps_x = 0;
    int steps_y = 0;
    canvas.own(cell, furrow);
    while (true) {
        const float next_x = across_x.first + static_cast<float>(steps_x) * across_x.step;
        const float next_y = across_y.first + static_cast<float>(steps_y) * across_y.step;
        const float next = std::min(next_x, next_y);
        if (!(next < length)) {
            met = false;
            return length;
        }
        if (next_x <= next_y) {
            cell.x = start.x + side.x * ++steps_x;
        } else {
            cell.y = start.y + side.y * ++steps_y;
        }
        if (canvas.is_obstacle(cell, furrow)) {
            met = true;
            return std::max(next, 0.0f);
        }
        canvas.own(cell, furrow);
    }
}

/// Coverage of a pixel at `distance` from the axis of a line of this width [px].
float line_coverage(float distance, float width) {
    const float half = 0.5f * width;
    const float overlap = std::min(distance + 0.5f, half) - std::max(distance - 0.5f, -half);
    return std::clamp(overlap, 0.0f, 1.0f);
}

/// Draws the furrow and its band around a segment.
void draw(
    Canvas& canvas, const Vec2& from, const Vec2& direction, float length, const FurrowShape& shape,
    std::uint32_t furrow) {
    const float band = 0.5f * shape.density;
    const float line = 0.5f * shape.width + 0.5f;
    const float owned = std::max(0.5f * shape.width, 0.5f);
    const float extent = std::max(std::max(band, line), owned);
    const float extent2 = extent * extent;
    const float band2 = band * band;
    const float line2 = line * line;
    const float owned2 = owned * owned;
    const Vec2 to = from + direction * length;
    const IVec2 low = cell_of(glm::min(from, to) - extent);
    const IVec2 high = cell_of(glm::max(from, to) + extent);
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            const Vec2 offset = Vec2(x, y) + 0.5f - from;
            const float along =
                std::clamp(offset.x * direction.x + offset.y * direction.y, 0.0f, length);
            const Vec2 away = offset - direction * along;
            const float distance2 = away.x * away.x + away.y * away.y;
            if (distance2 > extent2) {
                continue;
            }
            const int index = canvas.pixel({x, y});
            if (index < 0) {
                continue;
            }
            const auto pixel = static_cast<std::size_t>(index);
            std::uint32_t& cell = canvas.drawing.cells[pixel];
            cell |= distance2 <= band2 ? kFurrowBand : 0;
            cell |= distance2 <= owned2 && (cell & ~kFurrowBand) == 0 ? furrow | kFurrowBand : 0;
            if (distance2 < line2 && canvas.cover[pixel] >= 0) {
                const float distance =
                    distance2 > 1e-12f ? distance2 * repeatable_inverse_root(distance2) : 0.0f;
                const float height = 1.0f - shape.depth * line_coverage(distance, shape.width);
                float& drawn = canvas.drawing.height[pixel];
                drawn = std::min(drawn, height);
            }
        }
    }
}

/// The vector of `field` at `p`, in the triangle that covers its pixel.
Vec2 field_at(const FurrowTriangle& triangle, int field, const Vec2& p) {
    const Vec2 offset = p - triangle.corner[0];
    const Vec2& right = triangle.field_right[field];
    const Vec2& down = triangle.field_down[field];
    return {
        triangle.field[field].x + (right.x * offset.x + down.x * offset.y),
        triangle.field[field].y + (right.y * offset.x + down.y * offset.y)};
}

/// `p` within the image where that repeats.
Vec2 within(const FurrowMap& map, Vec2 p) {
    const Vec2 size(map.size);
    if (map.wrap_s) {
        p.x += p.x < 0 ? size.x : p.x >= size.x ? -size.x : 0.0f;
    }
    if (map.wrap_t) {
        p.y += p.y < 0 ? size.y : p.y >= size.y ? -size.y : 0.0f;
    }
    return p;
}

}  // namespace

FurrowShape furrow_shape(const FurrowStyle& style, float magnitude) {
    const FurrowFunctions& f = style.functions;
    const float x = std::clamp(magnitude, 0.0f, kMaxTracedMagnitude);
    const auto line = [x](const Vec2& coefficients) { return coefficients.x + coefficients.y * x; };
    const float limit = line(f.limit);
    FurrowShape shape;
    shape.angle = std::clamp(line(f.angle), -kMaxFurrowTurn, kMaxFurrowTurn);
    shape.length = std::max(style.scale * line(f.length), kMinFurrowStep);
    shape.density = std::max(style.scale * line(f.density), 0.0f);
    shape.width = style.scale * (f.width * x);
    shape.depth = f.depth * (x * x);
    shape.limit = limit > 0 ? static_cast<int>(limit) : 0;
    return shape;
}

std::vector<std::int32_t> cover_furrow_map(const FurrowMap& map) {
    std::vector<std::int32_t> cover(
        static_cast<std::size_t>(map.size.x) * static_cast<std::size_t>(map.size.y), -1);
    for (std::size_t t = map.triangles.size(); t-- > 0;) {  // the first one is drawn last
        const FurrowTriangle& triangle = map.triangles[t];
        const Vec2 low =
            glm::min(triangle.corner[0], glm::min(triangle.corner[1], triangle.corner[2]));
        const Vec2 high =
            glm::max(triangle.corner[0], glm::max(triangle.corner[1], triangle.corner[2]));
        const IVec2 first = cell_of(glm::clamp(low, Vec2(0), Vec2(map.size)));
        const IVec2 last =
            glm::min(cell_of(glm::clamp(high, Vec2(0), Vec2(map.size))), map.size - 1);
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                if (covers(triangle, Vec2(x, y) + 0.5f)) {
                    cover[static_cast<std::size_t>(y * map.size.x + x)] =
                        static_cast<std::int32_t>(t);
                }
            }
        }
    }
    return cover;
}

FurrowDrawing make_furrow_drawing(const FurrowMap& map) {
    const std::size_t pixels =
        static_cast<std::size_t>(map.size.x) * static_cast<std::size_t>(map.size.y);
    FurrowDrawing drawing;
    drawing.cells.resize(pixels, 0);
    drawing.height.resize(pixels, 1.0f);
    return drawing;
}

void trace_half_furrow(
    const FurrowMap& map, const std::vector<std::int32_t>& cover, const FurrowStyle& style,
    int field, std::uint32_t furrow, const Vec2& start, bool backward, FurrowDrawing& drawing,
    std::vector<FurrowSegment>* segments) {
    LIMN_CHECK(field == 0 || field == 1);
    Canvas canvas{map, cover, drawing};
    Vec2 p = start;
    int left = 0x7fffffff;
    for (std::uint32_t segment = 0;; ++segment) {
        const IVec2 cell = cell_of(p);
        if (canvas.is_obstacle(cell, furrow)) {
            return;
        }
        const int index = canvas.pixel(cell);
        drawing.cells[static_cast<std::size_t>(index)] |= kFurrowBand;
        const auto triangle = static_cast<std::size_t>(cover[static_cast<std::size_t>(index)]);
        Vec2 d = field_at(map.triangles[triangle], field, p);
        const float size2 = d.x * d.x + d.y * d.y;
        if (!(size2 > kStill * kStill)) {
            return;
        }
        const float inverse = repeatable_inverse_root(size2);
        const float magnitude = size2 * inverse;
        d = backward ? -(d * inverse) : d * inverse;
        const FurrowShape shape = furrow_shape(style, magnitude);
        const float turn =
            style.literal_turn
                ? 1.0f
                : 2.0f * furrow_turns(style, map.stream[field], furrow, backward, segment).uniform()
                      - 1.0f;
        const Vec2 rotation = repeatable_cos_sin(shape.angle * turn);
        const Vec2 direction(
            d.x * rotation.x - d.y * rotation.y, d.x * rotation.y + d.y * rotation.x);
        bool met = false;
        const float length = walk(canvas, p, direction, shape.length, furrow, met);
        draw(canvas, p, direction, length, shape, furrow);
        const Vec2 q = p + direction * length;
        if (segments != nullptr) {
            segments->push_back({p, q, shape.density, furrow, backward, met});
        }
        if (met || left <= 0) {
            return;
        }
        left = std::min(left, shape.limit) - 1;
        p = within(map, q);
    }
}

FurrowDrawing trace_furrows(
    const FurrowMap& map, const std::vector<std::int32_t>& cover, const FurrowStyle& style,
    int field, std::vector<FurrowSegment>* segments) {
    FurrowDrawing drawing = make_furrow_drawing(map);
    const Canvas canvas{map, cover, drawing};
    const auto try_start = [&](const Vec2& start, std::size_t id) {
        const bool inside = start.x >= 0 && start.y >= 0 && start.x < static_cast<float>(map.size.x)
                            && start.y < static_cast<float>(map.size.y);
        const int index = inside ? canvas.pixel(cell_of(start)) : -1;
        if (index < 0 || cover[static_cast<std::size_t>(index)] < 0
            || (drawing.cells[static_cast<std::size_t>(index)] & kFurrowBand) != 0) {
            return;
        }
        const auto furrow = static_cast<std::uint32_t>(id);
        trace_half_furrow(map, cover, style, field, furrow, start, false, drawing, segments);
        trace_half_furrow(map, cover, style, field, furrow, start, true, drawing, segments);
    };
    for (std::size_t t = 0; t < map.triangles.size(); ++t) {
        const FurrowTriangle& triangle = map.triangles[t];
        const Vec2 centroid =
            (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) * (1.0f / 3.0f);
        try_start(within(map, centroid), t + 1);
    }
    for (int y = 0; y < map.size.y; ++y) {
        for (int x = 0; x < map.size.x; ++x) {
            try_start(
                Vec2(x, y) + 0.5f,
                map.triangles.size() + static_cast<std::size_t>(y * map.size.x + x) + 1);
        }
    }
    return drawing;
}

}  // namespace limn
