#include "tests/render/scene_fixture.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace limn::test {

Renderer& shared_renderer() {
    static const RendererPtr renderer = [] {
        Result<RendererPtr> made = create_renderer(shared_device(), {.full_float = true});
        if (!made) {
            std::fprintf(stderr, "%s\n", made.error().message.c_str());
            std::exit(1);
        }
        return *std::move(made);
    }();
    return *renderer;
}

MeshData make_square() {
    MeshData mesh;
    mesh.name = "square";
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.tangents.assign(4, {1, 0, 0, 1});
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
    return mesh;
}

MeshData make_ball(int rings) {
    MeshData mesh;
    mesh.name = "ball";
    const int sectors = 2 * rings;
    for (int i = 0; i <= rings; ++i) {
        const float theta = kPi * static_cast<float>(i) / static_cast<float>(rings);
        for (int j = 0; j <= sectors; ++j) {
            const float phi = 2 * kPi * static_cast<float>(j) / static_cast<float>(sectors);
            const Vec3 n = {
                std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)};
            mesh.positions.push_back(n);
            mesh.normals.push_back(n);
            mesh.tangents.emplace_back(std::cos(phi), 0.0f, -std::sin(phi), 1.0f);
            mesh.uvs.emplace_back(
                static_cast<float>(j) / static_cast<float>(sectors),
                static_cast<float>(i) / static_cast<float>(rings));
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(i * (sectors + 1) + j);
    };
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            mesh.indices.insert(
                mesh.indices.end(), {index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j),
                                     index(i + 1, j + 1), index(i, j + 1)});
        }
    }
    mesh.bounds = {{-1, -1, -1}, {1, 1, 1}};
    return mesh;
}

Affine at(const Vec3& position) {
    return affine_from(position, {1, 0, 0, 0}, {1, 1, 1});
}

Scene::Scene() {
    world.insert_resource(Assets{});
}

Scene::~Scene() = default;

MeshId Scene::add(MeshData mesh) {
    auto& assets = world.resource<Assets>();
    assets.meshes.push_back(std::move(mesh));
    return {static_cast<std::uint32_t>(assets.meshes.size() - 1)};
}

MaterialId Scene::add(Material material) {
    auto& assets = world.resource<Assets>();
    assets.materials.push_back(std::move(material));
    return {static_cast<std::uint32_t>(assets.materials.size() - 1)};
}

ImageId Scene::add(ImageData image) {
    auto& assets = world.resource<Assets>();
    assets.images.push_back(std::move(image));
    return {static_cast<std::uint32_t>(assets.images.size() - 1)};
}

Entity Scene::place(MeshId mesh, MaterialId material, const Affine& now) {
    return world.create(
        MeshInstance{mesh, material}, WorldTransform{now}, PreviousWorldTransform{now});
}

RenderView Scene::look(const Vec3& eye, const Vec3& target, int width, int height) const {
    const Affine pose = look_at(eye, target);
    return make_render_view(
        {.fov_y = radians(90.0f), .near = 0.05f}, pose, pose, {.width = width, .height = height});
}

FrameOutput Scene::draw(const RenderView& view, const FrameRequest& request) {
    return render_frame(shared_renderer(), world, view, request);
}

gpu::FloatImage Scene::radiance(const RenderView& view) {
    return gpu::read_floats(*draw(view).radiance);
}

gpu::FloatImage Scene::aov(const RenderView& view, const std::string& name) {
    const FrameOutput out = draw(view, {.aovs = {name}});
    REQUIRE(out.aovs.size() == 1);
    return gpu::read_floats(*out.aovs[0].texture);
}

Vec3 rgb_at(const gpu::FloatImage& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

float largest_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    float largest = 0;
    REQUIRE(a.pixels.size() == b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    }
    return largest;
}

}  // namespace limn::test
