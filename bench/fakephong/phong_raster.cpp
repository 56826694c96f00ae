#include "bench/fakephong/phong_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limn::fakephong {
namespace {

/// A corner of a clipped triangle: camera space, z forwards, and where it lies on the whole
/// triangle.
struct ClipCorner {
    dvec3 at;
    dvec2 st;
};

/// On the screen: pixels, rows downwards; s/w, t/w and 1/w are linear there.
struct ScreenCorner {
    dvec2 at;
    dvec3 over_w;
};

constexpr double kNear = 1e-3;

/// The part of a triangle before the near plane: 0, 3 or 4 corners.
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

/// The function that is `values` at three points of the screen: value + x dx + y dy.
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

/// Whether a point exactly on the edge from a to b belongs to the triangle: it does to one of two
/// triangles that share the edge.
bool owns_edge(const dvec2& a, const dvec2& b) {
    return a.y == b.y ? b.x < a.x : b.y > a.y;
}

/// Calls visit(x, y, over_w) for the pixels whose centers lie in the triangle.
template <typename Visit>
void for_each_pixel(std::array<ScreenCorner, 3> p, int size, Visit visit) {
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
    for (int y = first(1); y < end(1); ++y) {
        const int x0 = first(0);
        dvec3 over_w = plane.value + (x0 + 0.5) * plane.dx + (y + 0.5) * plane.dy;
        for (int x = x0; x < end(0); ++x, over_w += plane.dx) {
            const dvec2 center(x + 0.5, y + 0.5);
            bool inside = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const dvec2& a = p[i].at;
                const dvec2& b = p[(i + 1) % 3].at;
                const double side = cross_2d(b - a, center - a);
                inside = inside && (side > 0 || (side == 0 && owns_edge(a, b)));
            }
            if (inside) {
                visit(x, y, over_w);
            }
        }
    }
}

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

dvec3 seen_color(const PhongScene& scene, const Lit& lit, const dvec2& uv) {
    dvec3 color = scene.material.color;
    const double checks = scene.material.checks;
    if (checks > 0 && std::isfinite(uv.x + uv.y)) {
        const double parity = std::floor(uv.x * checks) + std::floor(uv.y * checks);
        color *= std::fmod(std::abs(parity), 2.0) == 0 ? 1.0 : 0.5;
    }
    const dvec3 light = color * plain(lit.tinted) + plain(lit.highlight);
    return {clamp01(light.x).value, clamp01(light.y).value, clamp01(light.z).value};
}

PhongImage draw(const PhongScene& scene, const ShadingMethod& method) {
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
            screen.push_back({0.5 * size * (ndc + 1.0), dvec3(corner.st, 1) / w});
        }

        const Work before = counted_work;
        method.prepare(context, facet, setup);
        image.setup += counted_work - before;
        ++image.triangles;
        const std::array<dvec2, 3> uv = {
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][0]],
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][1]],
            mesh.uvs.empty() ? dvec2(0) : mesh.uvs[mesh.triangles[i][2]]};

        const auto shade = [&](int x, int y, const dvec3& over_w) {
            const auto pixel = static_cast<std::size_t>(y) * size + x;
            if (!(over_w.z > nearest[pixel])) {
                return;
            }
            nearest[pixel] = over_w.z;
            image.mask[pixel] = 1;
            ++image.pixels;
            const dvec2 st = dvec2(over_w) / over_w.z;
            const Work unshaded = counted_work;
            const Lit lit = method.shade(context, setup, st.x, st.y);
            image.shading += counted_work - unshaded;
            const dvec2 texture = (1 - st.x - st.y) * uv[0] + st.x * uv[1] + st.y * uv[2];
            image.color.pixels[pixel] = Vec3(seen_color(scene, lit, texture));
        };
        for (std::size_t k = 2; k < screen.size(); ++k) {
            for_each_pixel({screen[0], screen[k - 1], screen[k]}, size, shade);
        }
    }
    return image;
}

}  // namespace limn::fakephong
