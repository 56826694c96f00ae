// Highlights by texture: coordinates at samples, interpolated, one fetch per pixel and light.
// Everything but highlights is Gouraud-shaded (fakephong.envmap, .phong-map, .blinn-map,
// .quadratic-blinn, .hw-blinn).

#include "bench/fakephong/shading_method.h"

#include <algorithm>
#include <array>
#include <cstddef>

// Techniques: fakephong.blinn-map, fakephong.envmap, fakephong.hw-blinn, fakephong.phong-map,
//     fakephong.quadratic-blinn

namespace limn::fakephong {
namespace {

using Coordinates = Vec2r (*)(const PhongScene&, const PhongLight&, const SurfacePoint&);

/// Ambient and diffuse light as coefficients over the triangle; zero if only highlights are drawn.
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

/// Coefficients of the coordinates of each light; quadratic or linear.
void prepare_coordinates(
    const ShadingContext& context, const Facet& facet, Coordinates coordinates, bool quadratic,
    std::array<std::array<Vec2r, 6>, kMaxLights>& coefficients) {
    const PhongScene& scene = *context.scene;
    std::array<SurfacePoint, 6> points;
    if (quadratic) {
        points = six_points(facet);
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto at = [&](std::size_t k) {
            return coordinates(
                scene, scene.lights[i], quadratic ? points[k] : facet.corners[k / 2]);
        };
        if (quadratic) {
            coefficients[i] =
                quadratic_through(std::array<Vec2r, 6>{at(0), at(1), at(2), at(3), at(4), at(5)});
        } else {
            const auto c = linear_through(at(0), at(2), at(4));
            std::copy(c.begin(), c.end(), coefficients[i].begin());
        }
    }
}

/// The sum over lights of `fetched` at the light's coordinates, tinted by its color.
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

/// By one fetch per light.
Vec3r sum_fetches(
    const ShadingContext& context, const LookupTexture& texture, Real factor, bool quadratic,
    const std::array<std::array<Vec2r, 6>, kMaxLights>& coefficients, Real s, Real t) {
    return sum_lights(context, factor, [&](std::size_t i) {
        const auto& c = coefficients[i];
        return fetch(texture, quadratic ? evaluate_quadratic(c, s, t) : evaluate_linear(c, s, t));
    });
}

Vec3r shade_highlights(
    const ShadingContext& context, const FacetSetup& setup, Real s, Real t, bool quadratic) {
    return context.scene->channels == Channels::Diffuse
               ? Vec3r()
               : sum_fetches(
                   context, context.blinn, context.scene->material.specular, quadratic, setup.at, s,
                   t);
}

/// Blinn maps: highlights by texture, and with PhongScene::diffuse_texture all light.
void prepare_blinn(
    const ShadingContext& context, const Facet& facet, FacetSetup& setup, bool quadratic) {
    if (!context.scene->diffuse_texture) {
        prepare_tinted(context, facet, setup);
    } else if (context.scene->channels != Channels::Specular) {
        prepare_coordinates(context, facet, diffuse_coordinates, quadratic, setup.diffuse_at);
    }
    prepare_coordinates(context, facet, blinn_coordinates, quadratic, setup.at);
}
Lit shade_blinn(
    const ShadingContext& context, const FacetSetup& setup, Real s, Real t, bool quadratic) {
    const PhongScene& scene = *context.scene;
    Lit lit;
    if (!scene.diffuse_texture) {
        lit.tinted = shade_tinted(context, setup, s, t);
    } else if (scene.channels != Channels::Specular) {
        lit.tinted = Vec3r(dvec3(scene.material.ambient))
                     + sum_fetches(
                         context, context.diffuse, scene.material.diffuse, quadratic,
                         setup.diffuse_at, s, t);
    }
    lit.highlight = shade_highlights(context, setup, s, t, quadratic);
    return lit;
}

}  // namespace

// ---- environment map: all lights in one fetch, coordinates independent of the lights

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
    prepare_coordinates(context, facet, phong_map_coordinates, false, setup.at);
}

Lit shade_phong_map(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    const PhongMaterial& material = context.scene->material;
    if (context.scene->channels == Channels::Specular) {
        return {};
    }
    const Vec3r diffuse =
        sum_fetches(context, context.diffuse, material.diffuse, false, setup.at, s, t);
    return {diffuse + Vec3r(dvec3(material.ambient)), {}};
}

// ---- Blinn map

void prepare_blinn_map(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_blinn(context, facet, setup, false);
}

Lit shade_blinn_map(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return shade_blinn(context, setup, s, t, false);
}

// ---- quadratic Blinn map: coordinates at the six points of quadratic shading

void prepare_quadratic_blinn(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_blinn(context, facet, setup, true);
}

Lit shade_quadratic_blinn(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return shade_blinn(context, setup, s, t, true);
}

// ---- appendix B

void prepare_hardware_blinn(const ShadingContext& context, const Facet& facet, FacetSetup& setup) {
    prepare_tinted(context, facet, setup);
    prepare_coordinates(context, facet, blinn_coordinates_as_printed, false, setup.at);
}

Lit shade_hardware_blinn(const ShadingContext& context, const FacetSetup& setup, Real s, Real t) {
    return {shade_tinted(context, setup, s, t), shade_highlights(context, setup, s, t, false)};
}

}  // namespace limn::fakephong
