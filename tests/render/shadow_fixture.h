#pragma once

#include "bench/oracles/shadow_oracle.h"
#include "content/make/models/shapes.h"
#include "ecs/components/shadow.h"
#include "tests/render/scene_fixture.h"

#include <glm/geometric.hpp>

#include <vector>

namespace limn::test {

// The shadows of a light in an image, pixel by pixel, compared with ray casts.

/// A pixel of an image with one light.
struct Receiver {
    bool valid = false;  ///< a surface that faces the light, and in its cone
    oracle::DVec3 position;
    oracle::DVec3 normal;
    double visibility = 1;  ///< fraction of the light that is not shadowed
    /// Where rays start above the surface [m]: OpenGL may snap vertices to 1/256 of a pixel, and a
    /// position from a depth is as much off the plane as a shift by that moves the plane.
    double clearance = 1e-4;

    [[nodiscard]] oracle::DVec3 start() const { return position + clearance * normal; }
};

/// A light along -z of `pose`; a matte white scene in a black environment.
class ShadowTest : public Scene {
  public:
    MaterialId white = add(Material{
        .shading = ShadingModel::Blinn,
        .double_sided = true,
        .base_color = {1, 1, 1, 1},
        .specular = {0, 0, 0}});

    Entity put(MeshData mesh, const Vec3& position) {
        return place(add(std::move(mesh)), white, at(position));
    }

    /// Visibility of `light` in every pixel, row by row from the top: the image with its shadow
    /// over the one without.
    std::vector<Receiver> receivers(Entity light, const RenderView& view) {
        const Shadow shadow = world.get<Shadow>(light);
        const FrameOutput with = draw(view, {.aovs = {"depth", "normal"}});
        const gpu::FloatImage shaded = gpu::read_floats(*with.radiance);
        const gpu::FloatImage depth = gpu::read_floats(*with.aovs[0].texture);
        const gpu::FloatImage normal = gpu::read_floats(*with.aovs[1].texture);
        world.remove<Shadow>(light);
        const gpu::FloatImage full = radiance(view);
        world.add(light, shadow);

        std::vector<Receiver> all;
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                Receiver& r = all.emplace_back();
                r.valid = full.at(x, y, 0) > 1e-4f && depth.at(x, y, 0) < kNoDepth;
                if (r.valid) {
                    r.visibility = double(shaded.at(x, y, 0)) / full.at(x, y, 0);
                    r.position = point_of(view, x, y, depth.at(x, y, 0));
                    r.normal = {normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2)};
                    const double pixel = 2.0 * double(view.tangent.y) / view.height;
                    r.clearance += depth.at(x, y, 0) * pixel / 256;
                }
            }
        }
        return all;
    }

    /// The point `distance` along the view axis that a pixel shows.
    static oracle::DVec3 point_of(const RenderView& view, int x, int y, double distance) {
        const oracle::DVec3 in_view = {
            ((x + 0.5) / view.width * 2 - 1) * double(view.tangent.x) * distance,
            (1 - (y + 0.5) / view.height * 2) * double(view.tangent.y) * distance, -distance};
        oracle::DVec3 point;
        for (int i = 0; i < 3; ++i) {
            const Vec4& r = view.world_from_camera.row[i];
            point[i] = double(r.x) * in_view.x + double(r.y) * in_view.y + double(r.z) * in_view.z
                       + double(r.w);
        }
        return point;
    }
};

/// Fraction of the receivers on which image and ray casts agree whether they are lit.
template <typename Blocked>
double agreement(const std::vector<Receiver>& receivers, Blocked&& blocked) {
    int same = 0;
    int count = 0;
    for (const Receiver& r : receivers) {
        if (r.valid) {
            ++count;
            same += (r.visibility < 0.5) == blocked(r.start()) ? 1 : 0;
        }
    }
    REQUIRE(count > 0);
    return static_cast<double>(same) / count;
}

/// Pixels that a shift by a few texels does not explain.
struct WrongPixels {
    int acne = 0;      ///< dark where every ray nearby is free
    int floating = 0;  ///< lit where every ray nearby is blocked: the shadow left its caster
    int count = 0;     ///< pixels tested
};

/// `shift` [m]: tolerated offset of the shadow across the light; `to_light` gives the unit
/// vector from a point, `blocked` casts the ray.
template <typename ToLight, typename Blocked>
WrongPixels wrong_pixels(
    const std::vector<Receiver>& all, double shift, ToLight&& to_light, Blocked&& blocked) {
    WrongPixels wrong;
    for (const Receiver& r : all) {
        if (!r.valid) {
            continue;
        }
        ++wrong.count;
        const oracle::DVec3 start = r.start();
        const bool dark = r.visibility < 0.5;
        if (blocked(start) == dark) {
            continue;
        }
        // Around the point in its plane, as far as `shift` looks from the light.
        const oracle::DVec3 l = to_light(r.position);
        const double slope = std::max(glm::dot(r.normal, l), 1e-3);
        const oracle::DVec3 down = l - r.normal * glm::dot(r.normal, l);
        const oracle::DVec3 along = glm::length(down) > 1e-6
                                        ? glm::normalize(down)
                                        : oracle::DVec3(any_perpendicular(Vec3(r.normal)));
        const oracle::DVec3 across = glm::cross(r.normal, along);
        bool explained = false;
        for (int ring = 1; ring <= 2 && !explained; ++ring) {
            for (int i = 0; i < 8 && !explained; ++i) {
                const double angle = i * 0.785398163;
                const oracle::DVec3 offset =
                    (std::cos(angle) / slope) * along + std::sin(angle) * across;
                explained = blocked(start + (0.5 * ring * shift) * offset) == dark;
            }
        }
        wrong.acne += dark && !explained ? 1 : 0;
        wrong.floating += !dark && !explained ? 1 : 0;
    }
    return wrong;
}

}  // namespace limn::test
