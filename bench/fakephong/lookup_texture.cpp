#include "bench/fakephong/lookup_texture.h"

#include "bench/fakephong/blinn_illumination.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: fakephong.blinn-texture, fakephong.envmap-bake

namespace limn::fakephong {

LookupTexture bake_texture(int size, DiscFunction function) {
    LookupTexture texture = {.size = size, .texels = {}, .exact = std::move(function)};
    texture.texels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const bool edge = std::min(x, y) == 0 || std::max(x, y) == size - 1;
            texture.texels.push_back(
                edge ? dvec3(0)
                     : texture.exact(2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1));
        }
    }
    return texture;
}

Vec3r fetch(const LookupTexture& texture, const Vec2r& at) {
    ++counted_work.fetches;
    if (texture.size == 0) {
        return Vec3r(texture.exact(at.x.value, at.y.value));
    }
    // The filter belongs to the fetch; its arithmetic is not counted.
    const double last = texture.size - 1;
    const double x = std::clamp((at.x.value + 1) / 2 * texture.size - 0.5, 0.0, last);
    const double y = std::clamp((at.y.value + 1) / 2 * texture.size - 0.5, 0.0, last);
    const int x0 = static_cast<int>(x);
    const int y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, texture.size - 1);
    const int y1 = std::min(y0 + 1, texture.size - 1);
    const auto texel = [&texture](int i, int j) { return texture.texels[j * texture.size + i]; };
    const dvec3 top = glm::mix(texel(x0, y0), texel(x1, y0), x - x0);
    const dvec3 bottom = glm::mix(texel(x0, y1), texel(x1, y1), x - x0);
    return Vec3r(glm::mix(top, bottom, y - y0));
}

double blinn_texture_value(double exponent, double x, double y) {
    const double squared = 1 - x * x - y * y;
    return squared > 1e-12 ? std::pow(squared, exponent / 2) : 0.0;
}

dvec3 sphere_map_direction(double x, double y) {
    const double z = 1 - x * x - y * y;
    const double q = 2 * std::sqrt(std::max(z, 0.0));
    return {q * x, q * y, 2 * z - 1};
}

DiscFunction highlight_environment(const PhongScene& scene, const dvec3& center) {
    struct Lobe {
        dvec3 direction, color;
    };
    std::vector<Lobe> lobes;
    const CameraFrame camera = camera_frame(scene.camera);
    for (const PhongLight& light : scene.lights) {
        const dvec3 l = plain(to_light(light, Vec3r(center)));
        lobes.push_back(
            {{glm::dot(l, camera.right), glm::dot(l, camera.up), glm::dot(l, camera.back)},
             light.color});
    }
    return [lobes, exponent = scene.environment_exponent](double x, double y) {
        dvec3 sum(0);
        if (x * x + y * y <= 1) {
            const dvec3 w = sphere_map_direction(x, y);
            for (const Lobe& lobe : lobes) {
                const double cosine = glm::dot(w, lobe.direction);
                sum += cosine > 0 ? std::pow(cosine, exponent) * lobe.color : dvec3(0);
            }
        }
        return sum;
    };
}

}  // namespace limn::fakephong
