// Highlights by texture: coordinates at samples, interpolated, one fetch per pixel and light. What
// is not a highlight is Gouraud's (fakephong.envmap, .phong-map, .blinn-map, .quadratic-blinn,
// .hw-blinn).

#include "bench/fakephong/shading_method.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace limn::fakephong {
namespace {

using Coordinates = Vec2r (*)(const PhongScene&, const PhongLight&, const SurfacePoint&);

/// Ambient and diffuse light as coefficients over the triangle; none where only highlights are
/// drawn.
void prepare_tinted(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    if (context.scene->channels == Channels::Specular) {
        return;
    }
    PhongScene diffuse = {.lights = context.scene->lights, .channels = Channels::Diffuse};
    diffuse.material = context.scene->material;
    const auto lit = [&](std::size_t i) { return illuminate(diffuse, facet.corners[i]); };
    const auto c = linear_through(lit(0), lit(1), lit(2));
    std::copy(c.begin(), c.end(), setup.lit.begin());
}

Vec3r shade_tinted(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return context.scene->channels == Channels::Specular
               ? Vec3r()
               : setup.lit[0].tinted + s * setup.lit[1].tinted + t * setup.lit[2].tinted;
}

void prepare_linear(
    const ShadingContext& context, const Facet& facet, FacetSetup& setup, Coordinates coordinates) {
    prepare_tinted(context, facet, setup);
    const PhongScene& scene = *context.scene;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto at = [&](std::size_t corner) {
            return coordinates(scene, scene.lights[i], facet.corners[corner]);
        };
        const auto c = linear_through(at(0), at(1), at(2));
        std::copy(c.begin(), c.end(), setup.at[i].begin());
    }
}

/// The sum over lights of what `fetched` of a light's coordinates gives, tinted by its color.
template <typename Fetched>
Vec3r sum_lights(const ShadingContext& context, Real factor, Fetched fetched) {
    Vec3r sum;
    const auto& lights = context.scene->lights;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Real value = factor * fetched(i).x;
        sum = sum + value * Vec3r(lights[i].color);
    }
    return sum;
}

Lit shade_highlights(
    const ShadingContext& context, const FacetSetup& setup, Real s, Real t, bool quadratic) {
    Lit lit = {shade_tinted(context, setup, s, t), {}};
    if (context.scene->channels != Channels::Diffuse) {
        lit.highlight = sum_lights(context, context.scene->material.specular, [&](std::size_t i) {
            const auto& c = setup.at[i];
            return fetch(
                context.blinn, quadratic ? evaluate_quadratic(c, s, t) : evaluate_linear(c, s, t));
        });
    }
    return lit;
}

}  // namespace

// ---- environment map: all lights in one fetch, no light in the coordinates

void prepare_environment(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_tinted(context, facet, setup);
    const auto at = [&](std::size_t i) {
        return sphere_map_coordinates(*context.scene, facet.corners[i]);
    };
    const auto c = linear_through(at(0), at(1), at(2));
    std::copy(c.begin(), c.end(), setup.at[0].begin());
}

Lit shade_environment(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    Lit lit = {shade_tinted(context, setup, s, t), {}};
    if (context.scene->channels != Channels::Diffuse) {
        lit.highlight = context.scene->material.specular
                        * fetch(context.environment, evaluate_linear(setup.at[0], s, t));
    }
    return lit;
}

// ---- Phong map: diffuse light only

void prepare_phong_map(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    const PhongScene& scene = *context.scene;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto at = [&](std::size_t corner) {
            return phong_map_coordinates(scene, scene.lights[i], facet.corners[corner]);
        };
        const auto c = linear_through(at(0), at(1), at(2));
        std::copy(c.begin(), c.end(), setup.at[i].begin());
    }
}

Lit shade_phong_map(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    const PhongMaterial& material = context.scene->material;
    if (context.scene->channels == Channels::Specular) {
        return {};
    }
    const Vec3r diffuse = sum_lights(context, material.diffuse, [&](std::size_t i) {
        return fetch(context.diffuse, evaluate_linear(setup.at[i], s, t));
    });
    return {diffuse + Vec3r(dvec3(material.ambient)), {}};
}

// ---- Blinn map

void prepare_blinn_map(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_linear(context, facet, setup, blinn_coordinates);
}

Lit shade_blinn_map(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return shade_highlights(context, setup, s, t, false);
}

// ---- quadratic Blinn map: coordinates at the six points of quadratic shading

void prepare_quadratic_blinn(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_tinted(context, facet, setup);
    const PhongScene& scene = *context.scene;
    const auto points = six_points(facet);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        std::array<Vec2r, 6> at;
        for (std::size_t k = 0; k < 6; ++k) {
            at[k] = blinn_coordinates(scene, scene.lights[i], points[k]);
        }
        setup.at[i] = quadratic_through(at);
    }
}

Lit shade_quadratic_blinn(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return shade_highlights(context, setup, s, t, true);
}

// ---- appendix B

void prepare_hardware_blinn(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_linear(context, facet, setup, blinn_coordinates_as_printed);
}

Lit shade_hardware_blinn(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return shade_highlights(context, setup, s, t, false);
}

}  // namespace limn::fakephong
