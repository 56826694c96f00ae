#include "bench/fakephong/phong_raster.h"

#include "bench/fakephong/forward_difference.h"
#include "ecs/base/check.h"

#include <algorithm>
#include <array>
#include <cmath>

// Techniques: fakephong.barycentric, fakephong.forward-difference, fakephong.texmap

namespace limn::fakephong {
namespace {

/// A corner of a clipped triangle: camera space, z forwards, and its position on the whole
/// triangle.
struct ClipCorner {
    dvec3 at;
    dvec2 st;
};

/// On the screen: pixels, rows downwards; s/w, t/w and 1/w are linear there, or s, t and 1/w.
struct ScreenCorner {
    dvec2 at;
    dvec3 over_w;
};

constexpr double kNear = 1e-3;

/// The part of a triangle beyond the near plane: 0, 3 or 4 corners.
std::vector<ClipCorner> clip_near(const std::array<ClipCorner, 3>& corners) {
    std::vector<ClipCorner> kept;
    for (std::size_t i = 0; i < 3; ++i) {
        const ClipCorner& a = corners[i];
        const ClipCorner& b = corners[(i + 1) % 3];
        if (a.at.z >= kNear) {
            kept.push_back(a);
        }
        if ((a.at.z >= kNear) != (b.at.z >= kNear)) {
            const double k = (kNear - a.at.z) / (b.at.z - a.at.z);
            kept.push_back({glm::mix(a.at, b.at, k), glm::mix(a.st, b.st, k)});
        }
    }
    return kept;
}

/// The linear function with `values` at three points of the screen: value + x dx + y dy.
struct ScreenPlane {
    dvec3 value, dx, dy;
};
ScreenPlane plane_through(const std::array<ScreenCorner, 3>& p, double area) {
    const dvec2 e1 = p[1].at - p[0].at;
    const dvec2 e2 = p[2].at - p[0].at;
    const dvec3 v1 = p[1].over_w - p[0].over_w;
    const dvec3 v2 = p[2].over_w - p[0].over_w;
    const dvec3 dx = (e2.y * v1 - e1.y * v2) / area;
    const dvec3 dy = (e1.x * v2 - e2.x * v1) / area;
    return {p[0].over_w - p[0].at.x * dx - p[0].at.y * dy, dx, dy};
}

double cross_2d(const dvec2& a, const dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Whether a point exactly on the edge from a to b belongs to the triangle: exactly one of two
/// triangles that share the edge owns it.
bool owns_edge(const dvec2& a, const dvec2& b) {
    return a.y == b.y ? b.x < a.x : b.y > a.y;
}

/// The pixels of a row whose centers lie in a triangle; over_w is that of the first.
struct Span {
    int y = 0;
    int begin = 0, end = 0;
    dvec3 over_w;
};

/// Calls visit(span, plane) for the rows of a triangle, from the top.
template <typename Visit>
void for_each_span(std::array<ScreenCorner, 3> p, int size, Visit visit) {
    double area = cross_2d(p[1].at - p[0].at, p[2].at - p[0].at);
    if (!std::isfinite(area) || area == 0) {
        return;
    }
    if (area < 0) {
        std::swap(p[1], p[2]);
        area = -area;
    }
    const ScreenPlane plane = plane_through(p, area);
    const auto low = [&p](int k) { return std::min({p[0].at[k], p[1].at[k], p[2].at[k]}); };
    const auto high = [&p](int k) { return std::max({p[0].at[k], p[1].at[k], p[2].at[k]}); };
    const auto first = [&](int k) {
        return static_cast<int>(std::floor(std::clamp(low(k), 0.0, static_cast<double>(size))));
    };
    const auto end = [&](int k) {
        return static_cast<int>(std::ceil(std::clamp(high(k), 0.0, static_cast<double>(size))));
    };
    const auto covers = [&p](int x, int y) {
        const dvec2 center(x + 0.5, y + 0.5);
        for (std::size_t i = 0; i < 3; ++i) {
            const dvec2& a = p[i].at;
            const dvec2& b = p[(i + 1) % 3].at;
            const double side = cross_2d(b - a, center - a);
            if (!(side > 0 || (side == 0 && owns_edge(a, b)))) {
                return false;
            }
        }
        return true;
    };
    for (int y = first(1); y < end(1); ++y) {
        Span span = {.y = y, .begin = first(0), .end = 0, .over_w = {}};
        while (span.begin < end(0) && !covers(span.begin, y)) {
            ++span.begin;
        }
        span.end = span.begin;
        while (span.end < end(0) && covers(span.end, y)) {
            ++span.end;
        }
        if (span.begin < span.end) {
            span.over_w = plane.value + (span.begin + 0.5) * plane.dx + (y + 0.5) * plane.dy;
            visit(span, plane);
        }
    }
}

/// Colors of a triangle by forward differences: a table walks along its left edge, and each row
/// starts with a copy.
class ColorWalk {
  public:
    ColorWalk(const ShadingContext& context, const ShadingMethod& method, const FacetSetup& setup)
        : context_(context), method_(method), setup_(setup) {}

    [[nodiscard]] RowDifferences<Lit> start_row(const Span& span, const ScreenPlane& plane) {
        if (!started_) {
            started_ = true;
            table_ =
                difference_table<Lit>(static_cast<std::size_t>(method_.degree), [&](int x, int y) {
                    const dvec3 at = span.over_w + static_cast<double>(x) * plane.dx
                                     + static_cast<double>(y) * plane.dy;
                    return method_.shade(context_, setup_, at.x, at.y);
                });
            x_ = span.begin;
            y_ = span.y;
        }
        for (; y_ < span.y; ++y_) {
            step_down(table_);
        }
        for (; x_ < span.begin; ++x_) {
            step_right(table_);
        }
        for (; x_ > span.begin; --x_) {
            step_left(table_);
        }
        return table_.rows[0];
    }

  private:
    const ShadingContext& context_;
    const ShadingMethod& method_;
    const FacetSetup& setup_;
    PixelDifferences<Lit> table_ = {};
    bool started_ = false;
    int x_ = 0;
    int y_ = 0;
};

}  // namespace

bool make_facet(const PhongMesh& mesh, std::size_t index, Facet& facet) {
    const auto& corners = mesh.triangles[index];
    const dvec3& p0 = mesh.positions[corners[0]];
    const dvec3 normal =
        glm::cross(mesh.positions[corners[1]] - p0, mesh.positions[corners[2]] - p0);
    const double length = glm::length(normal);
    if (!std::isfinite(length) || !(length > 1e-30)) {
        return false;
    }
    const dvec3 face = normal / length;
    facet.face_normal = Vec3r(face);
    for (std::size_t i = 0; i < 3; ++i) {
        const dvec3& n = mesh.normals[corners[i]];
        const double squared = glm::dot(n, n);
        const bool valid = std::isfinite(squared) && squared > 1e-24;
        facet.corners[i] = {
            Vec3r(mesh.positions[corners[i]]), Vec3r(valid ? n / std::sqrt(squared) : face)};
    }
    return true;
}

dvec3 visible_color(const PhongScene& scene, const Lit& lit, const dvec2& uv) {
    dvec3 color = scene.material.color;
    const double checks = scene.material.checks;
    if (checks > 0 && std::isfinite(uv.x + uv.y)) {
        const double parity = std::floor(uv.x * checks) + std::floor(uv.y * checks);
        color *= std::fmod(std::abs(parity), 2.0) == 0 ? 1.0 : 0.5;
    }
    const dvec3 light = color * plain(lit.tinted) + plain(lit.highlight);
    return {clamp01(light.x).value, clamp01(light.y).value, clamp01(light.z).value};
}

PhongImage draw(const PhongScene& scene, const ShadingMethod& method, Evaluation evaluation) {
    const bool stepped = evaluation == Evaluation::Differences;
    const bool on_screen = scene.interpolation == Interpolation::Screen;
    LIMN_CHECK(!stepped || (method.degree > 0 && on_screen));
    const int size = scene.camera.size;
    const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    PhongImage image;
    image.color = {.width = size, .height = size, .pixels = std::vector<Vec3>(count, Vec3(0))};
    image.mask.assign(count, 0);
    std::vector<double> nearest(count, 0.0);  // 1/w, so that 0 is infinitely far

    const ShadingContext context = make_shading_context(scene);
    const CameraFrame camera = camera_frame(scene.camera);
    const PhongMesh& mesh = scene.mesh;
    FacetSetup setup;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Facet facet;
        if (!make_facet(mesh, i, facet)
            || !(
                glm::dot(
                    plain(facet.face_normal), scene.camera.eye - plain(facet.corners[0].position))
                > 0)) {
            continue;
        }
        std::array<ClipCorner, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const dvec3 d = plain(facet.corners[k].position) - scene.camera.eye;
            corners[k] = {
                {glm::dot(d, camera.right), glm::dot(d, camera.up), -glm::dot(d, camera.back)},
                {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}};
        }
        const std::vector<ClipCorner> clipped = clip_near(corners);
        if (clipped.empty()) {
            continue;
        }
        std::vector<ScreenCorner> screen;
        for (const ClipCorner& corner : clipped) {
            const double w = corner.at.z;
            const dvec2 ndc = dvec2(corner.at.x, -corner.at.y) / (w * scene.camera.half_size);
            screen.push_back(
                {0.5 * size * (ndc + 1.0),
                 on_screen ? dvec3(corner.st, 1 / w) : dvec3(corner.st, 1) / w});
        }

        const Work before = counted_work;
        method.prepare(context, facet, setup);
        image.setup += counted_work - before;
        ++image.triangles;
        const std::array<dvec2, 3> uv = {
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][0]],
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][1]],
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][2]]};

        const auto light_at = [&](const dvec2& st) {
            return method.shade(context, setup, st.x, st.y);
        };
        const auto draw_triangle = [&](const std::array<ScreenCorner, 3>& triangle) {
            ColorWalk walk(context, method, setup);
            for_each_span(triangle, size, [&](const Span& span, const ScreenPlane& plane) {
                const Work unshaded = counted_work;
                RowDifferences<Lit> row;
                if (stepped) {
                    row = walk.start_row(span, plane);
                }
                dvec3 over_w = span.over_w;
                for (int x = span.begin; x < span.end; ++x, over_w += plane.dx) {
                    if (stepped && x > span.begin) {
                        step(row);
                    }
                    const auto pixel = static_cast<std::size_t>(span.y) * size + x;
                    if (over_w.z > nearest[pixel]) {
                        nearest[pixel] = over_w.z;
                        image.mask[pixel] = 1;
                        ++image.pixels;
                        const dvec2 st = on_screen ? dvec2(over_w) : dvec2(over_w) / over_w.z;
                        const dvec2 texture =
                            (1 - st.x - st.y) * uv[0] + st.x * uv[1] + st.y * uv[2];
                        image.color.pixels[pixel] = Vec3(visible_color(
                            scene, stepped ? row.of_order[0] : light_at(st), texture));
                    }
                }
                image.shading += counted_work - unshaded;
            });
        };
        for (std::size_t k = 2; k < screen.size(); ++k) {
            draw_triangle({screen[0], screen[k - 1], screen[k]});
        }
    }
    return image;
}

}  // namespace limn::fakephong
