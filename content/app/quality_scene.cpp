#include "content/app/quality_scene.h"

#include "ecs/components/camera.h"
#include "ecs/components/environment.h"
#include "ecs/components/transform.h"

#include <cmath>

namespace limn {
namespace {

float encoded(float linear) {
    const float x = linear > 0.0f ? std::min(linear, 1.0f) : 0.0f;  // NaN becomes 0
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

}  // namespace

QualityScene::QualityScene() {
    world.insert_resource(Assets{});
}

MeshId QualityScene::add(MeshData mesh) {
    auto& meshes = world.resource<Assets>().meshes;
    meshes.push_back(std::move(mesh));
    return {static_cast<std::uint32_t>(meshes.size() - 1)};
}

MaterialId QualityScene::add(Material material) {
    auto& materials = world.resource<Assets>().materials;
    materials.push_back(std::move(material));
    return {static_cast<std::uint32_t>(materials.size() - 1)};
}

Entity QualityScene::place(MeshId mesh, MaterialId material, const Affine& pose) {
    return world.create(
        MeshInstance{mesh, material}, WorldTransform{pose}, PreviousWorldTransform{pose});
}

gpu::FloatImage
QualityScene::radiance(HeadlessRenderer& headless, const RenderView& view, int samples) {
    return gpu::read_floats(*render_accumulated(*headless.renderer, world, view, samples).radiance);
}

Affine placed_at(const Vec3& position, float scale) {
    return affine_from(position, {1, 0, 0, 0}, Vec3(scale));
}

RenderView quality_view(const Vec3& eye, const Vec3& target, int width, int height, float fov_y) {
    const Affine pose = look_at(eye, target);
    return make_render_view(
        {.fov_y = fov_y, .near = 0.05f}, pose, pose, {.width = width, .height = height});
}

MeshData quality_square() {
    MeshData mesh;
    mesh.name = "square";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    for (const Vec3& position : mesh.positions) {
        grow(mesh.bounds, position);
    }
    return mesh;
}

ColorImage displayed(const gpu::FloatImage& radiance) {
    ColorImage image{.width = radiance.width, .height = radiance.height, .pixels = {}};
    image.pixels.reserve(static_cast<std::size_t>(image.width) * image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            image.pixels.emplace_back(
                encoded(radiance.at(x, y, 0)), encoded(radiance.at(x, y, 1)),
                encoded(radiance.at(x, y, 2)));
        }
    }
    return image;
}

}  // namespace limn
