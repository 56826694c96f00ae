#include "content/app/quality_court.h"

#include "content/make/masonry.h"
#include "content/make/shapes.h"

namespace limn {

void furnish_court(QualityScene& scene) {
    const MaterialId floor =
        scene.add(Material{.base_color = {0.55f, 0.52f, 0.47f, 1}, .roughness = 0.9f});
    const MaterialId stone =
        scene.add(Material{.base_color = {0.62f, 0.57f, 0.48f, 1}, .roughness = 0.9f});
    const MaterialId clay =
        scene.add(Material{.base_color = {0.55f, 0.2f, 0.1f, 1}, .roughness = 0.7f});
    const MaterialId blue =
        scene.add(Material{.base_color = {0.1f, 0.2f, 0.38f, 1}, .roughness = 0.6f});

    scene.place(scene.add(make_box({.size = {14, 0.2f, 14}})), floor, placed_at({0, -0.1f, 0}));
    scene.place(
        scene.add(make_wall(
            {.size = {16, 3.6f, 0.4f},
             .span = 1.3f,
             .spring = 1.2f,
             .rise = 1.2f,
             .segments = 10})),
        stone, placed_at({-0.6f, 0, -2.6f}));
    const MeshId column = scene.add(make_lathe(
        {.profile =
             {{0.3f, 0}, {0.3f, 0.12f}, {0.19f, 0.24f}, {0.16f, 2}, {0.28f, 2.2f}, {0.28f, 2.35f}},
         .segments = 24}));
    for (const float x : {-2.7f, 1.0f}) {
        scene.place(column, stone, placed_at({x, 0, -1.3f}));
    }
    scene.place(
        scene.add(make_box({.size = {1, 0.5f, 1}})), stone,
        affine_from({-0.9f, 0.25f, 0.1f}, glm::angleAxis(0.4f, Vec3(0, 1, 0)), Vec3(1)));
    scene.place(
        scene.add(make_sphere({.radius = 0.34f, .segments = 32, .rings = 16})), blue,
        placed_at({-0.9f, 0.9f, 0.1f}));
    scene.place(
        scene.add(make_torus({.radius = 0.6f, .tube = 0.09f, .segments = 48, .sides = 16})), clay,
        affine_from({-0.9f, 1.05f, 0.1f}, glm::angleAxis(1.15f, Vec3(1, 0, 0.35f)), Vec3(1)));
    const MeshId bar = scene.add(make_cylinder({.radius = 0.03f, .height = 0.9f, .segments = 10}));
    for (int i = 0; i < 7; ++i) {
        scene.place(bar, clay, placed_at({0.55f + 0.22f * static_cast<float>(i), 0.45f, 0.75f}));
    }
    scene.place(
        scene.add(make_box({.size = {1.6f, 0.07f, 0.07f}})), clay,
        placed_at({1.21f, 0.93f, 0.75f}));
}

RenderView court_view(int width, int height) {
    return quality_view({1.7f, 2.5f, 4.4f}, {-0.25f, 0.75f, -0.6f}, width, height, radians(42.0f));
}

}  // namespace limn
