#include "bench/oracles/cluster_oracle.h"
#include "bench/oracles/cluster_readback.h"
#include "bench/oracles/light_oracle.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

namespace limn::test::cluster_test {
namespace {

class RandomLights {
  public:
    explicit RandomLights(unsigned seed) : random_(seed) {}
    float signed_unit() { return unit_(random_); }
    Vec3 in_cube(float half) { return half * Vec3(signed_unit(), signed_unit(), signed_unit()); }
    Vec3 direction() { return normalize_or(in_cube(1), {0, 1, 0}); }

    /// Point lights and, every third, a spot.
    LightRange reach() {
        LightRange light = {in_cube(25), std::exp2(3 * signed_unit())};
        if (++made_ % 3 == 0) {
            light.axis = direction();
            light.cosine = std::cos(radians(45 + 44 * signed_unit()));
        }
        return light;
    }
    RenderView view() {
        const Affine pose = look_at(in_cube(15), in_cube(15));
        return make_render_view(
            {.fov_y = radians(70 + 40 * signed_unit()), .near = 0.1f}, pose, pose,
            {.width = 333, .height = 190, .jitter = {0.3f * signed_unit(), 0.4f}});
    }

  private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> unit_{-1, 1};
    int made_ = 0;
};

LightList list_of(std::vector<LightRange> reach, int directional = 0) {
    LightList list;
    list.reach = std::move(reach);
    list.directional = directional;
    return list;
}

class ClusterTest : public RenderTest {
  public:
    oracle::ClusterReadbackLists build(const RenderView& view, const LightList& lights) {
        // One for all tests, like the shared renderer.
        static auto& readback =
            *new oracle::ClusterReadback(*oracle::ClusterReadback::create(device()));
        return readback.run(view, lights);
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    ClusterTest,
    "clusters: no light that reaches a visible point is missing, in 1e5 random tests") {
    RandomLights random(5);
    int tests = 0;
    int reached = 0;
    while (tests < 100000 || reached < 10000) {
        const RenderView view = random.view();
        std::vector<LightRange> reach;
        for (int i = 0; i < 60; ++i) {
            reach.push_back(random.reach());
        }
        const oracle::ClusterReadbackLists lists = build(view, list_of(reach, 2));
        for (int k = 0; k < 400; ++k) {
            // A point that some light reaches, so that the test is not wasted on the dark.
            const LightRange& chosen = reach[k % reach.size()];
            const Vec3 p = chosen.center + random.in_cube(chosen.radius);
            const Vec4 clip = view.clip_from_world * Vec4(p, 1);
            if (clip.w < view.near || std::abs(clip.x) >= clip.w || std::abs(clip.y) >= clip.w) {
                continue;
            }
            const float x = (clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(view.width);
            const float y = (clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(view.height);
            const auto listed = lists.of(cell_of(lists.shape, x, y, clip.w));
            for (std::size_t i = 0; i < reach.size(); ++i) {
                ++tests;
                if (oracle::reaches(reach[i], p)) {
                    ++reached;
                    REQUIRE(std::find(listed.begin(), listed.end(), i + 2) != listed.end());
                }
            }
        }
    }
    CHECK(tests >= 100000);
}

TEST_CASE_FIXTURE(
    ClusterTest, "clusters: no list holds a light whose sphere is off the cell's box") {
    RandomLights random(11);
    for (int n = 0; n < 6; ++n) {
        const RenderView view = random.view();
        std::vector<LightRange> reach;
        for (int i = 0; i < 100; ++i) {
            reach.push_back(random.reach());
            reach.back().cosine = -1;  // the sphere around a narrow cone ends beyond the radius
        }
        const oracle::ClusterReadbackLists lists = build(view, list_of(reach));
        const auto allowed = oracle::brute_force_lists(view, lists.shape, reach, 4e-3);
        int listed = 0;
        int within = 0;
        for (int cell = 0; cell < lists.shape.cells(); ++cell) {
            const auto list = lists.of(cell);
            listed += static_cast<int>(list.size());
            within += static_cast<int>(allowed[cell].size());
            REQUIRE(std::includes(
                allowed[cell].begin(), allowed[cell].end(), list.begin(), list.end()));
        }
        // A box around a cell is wider than the cell: not all of the oracle's are needed.
        CHECK(listed > within / 3);
        CHECK(lists.total() <= lists.capacity);
    }
}

TEST_CASE_FIXTURE(
    ClusterTest, "clusters: 4,096 lights, few a cell, each list in order, twice the same bits") {
    RandomLights random(9);
    const Affine pose = look_at({0, 0, 60}, {0, 0, 0});
    const RenderView view = make_render_view({}, pose, pose, {.width = 640, .height = 360});
    std::vector<LightRange> reach;
    for (int i = 0; i < 4096; ++i) {
        reach.push_back({random.in_cube(40), 1.5f});
    }
    const oracle::ClusterReadbackLists lists = build(view, list_of(reach));
    for (int cell = 0; cell < lists.shape.cells(); ++cell) {
        const auto listed = lists.of(cell);
        REQUIRE(std::is_sorted(listed.begin(), listed.end()));
    }
    CHECK(lists.total() > 4096);
    CHECK(lists.total() < 20 * lists.cells.size());
    CHECK(lists.total() <= lists.capacity);
    const oracle::ClusterReadbackLists again = build(view, list_of(reach));
    CHECK(lists.cells == again.cells);
    CHECK(std::equal(
        lists.indices.begin(), lists.indices.begin() + static_cast<std::ptrdiff_t>(lists.total()),
        again.indices.begin()));
}

TEST_CASE_FIXTURE(
    ClusterTest,
    "clusters: each list begins where the one before it ends, for any number of cells") {
    RandomLights random(3);
    for (const IVec2 size : {IVec2(1, 1), IVec2(33, 31), IVec2(700, 300), IVec2(1920, 1080)}) {
        const Affine pose = look_at({0, 0, 20}, {0, 0, 0});
        const RenderView view =
            make_render_view({}, pose, pose, {.width = size.x, .height = size.y});
        std::vector<LightRange> reach;
        for (int i = 0; i < 70; ++i) {
            reach.push_back(random.reach());
        }
        const oracle::ClusterReadbackLists lists = build(view, list_of(reach));
        layout::uint end = 0;
        for (const layout::uvec2& cell : lists.cells) {
            REQUIRE(cell.x == end);
            end += cell.y;
        }
        CHECK(end > 0);
        CHECK(end <= lists.capacity);
    }
}

TEST_CASE_FIXTURE(
    ClusterTest, "clusters: a light without an end is in every cell, no light is in none") {
    const Affine pose = look_at({0, 0, 5}, {0, 0, 0});
    const RenderView view = make_render_view({}, pose, pose, {.width = 100, .height = 70});
    const oracle::ClusterReadbackLists endless = build(view, list_of({{{1e3f, 0, 0}, INFINITY}}));
    CHECK(endless.total() == endless.cells.size());
    CHECK(endless.total() == endless.capacity);
    CHECK(build(view, list_of({})).total() == 0);
    CHECK(build(view, list_of({{{0, 0, 50}, 3}})).capacity == 0);   // behind the camera
    CHECK(build(view, list_of({{{80, 0, 0}, 3}})).capacity == 0);   // beside the image
    CHECK(build(view, list_of({{{0, 0, 5.5f}, 1}})).capacity > 0);  // behind, but reaches past
}

TEST_CASE("clusters: what would overflow the lists is left out, counted, and lost to no other") {
    const Affine pose = look_at({0, 0, 5}, {0, 0, 0});
    const RenderView view = make_render_view({}, pose, pose, {.width = 1920, .height = 1080});
    std::vector<LightRange> reach(1000, {{0, 0, 0}, INFINITY});
    reach.push_back({{0, 0, 0}, 1});
    ClusterLights clusters;
    place_lights(view, list_of(reach), clusters);
    CHECK(clusters.dropped > 0);
    CHECK(clusters.capacity <= kMaxListEntries);
    CHECK(clusters.dropped + static_cast<int>(clusters.lights.size()) == 1001);

    clusters.max_entries = 65536;  // the smallest GL_MAX_TEXTURE_BUFFER_SIZE that OpenGL allows
    place_lights(view, list_of(reach), clusters);
    CHECK(clusters.capacity <= 65536);
    CHECK(clusters.dropped + static_cast<int>(clusters.lights.size()) == 1001);
}

TEST_CASE_FIXTURE(
    Scene, "clusters: the image equals the sum of all lights at every pixel"
               * technique("deferred.light-pass")) {
    const Material matte = {
        .shading = ShadingModel::Blinn, .base_color = {0.8f, 0.8f, 0.8f, 1}, .specular = {0, 0, 0}};
    place(add(make_square()), add(matte), affine_from({0, 0, 0}, {1, 0, 0, 0}, {40, 40, 1}));
    RandomLights random(21);
    std::vector<std::pair<PointLight, Vec3>> lights;
    for (int i = 0; i < 150; ++i) {
        Vec3 p = random.in_cube(10);
        p.z = 0.3f + std::abs(p.z) * 0.1f;
        const Vec3 color = Vec3(0.5f) + 0.5f * random.direction();
        lights.push_back({{.color = color, .intensity = 3, .radius = 2 + random.signed_unit()}, p});
        shine(lights.back().first, at(p));
    }
    // Slanting, so that the plane crosses many slices.
    const Vec3 eye = {0, -12, 4};
    const RenderView view = look(eye, {0, 0, 0}, 160, 100);
    const gpu::FloatImage image = radiance(view);
    const Mat4 world_from_clip = glm::inverse(view.clip_from_world);
    double worst = 0;
    int lit = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Vec2 ndc = {
                (static_cast<float>(x) + 0.5f) / 80 - 1, 1 - (static_cast<float>(y) + 0.5f) / 50};
            const Vec4 p4 = world_from_clip * Vec4(ndc, 1, 1);
            const glm::dvec3 through = glm::dvec3(p4) / static_cast<double>(p4.w) - glm::dvec3(eye);
            const glm::dvec3 p = glm::dvec3(eye) + through * (-eye.z / through.z);
            if (through.z >= 0 || std::abs(p.x) > 39 || std::abs(p.y) > 39) {
                continue;
            }
            glm::dvec3 sum(0);
            for (const auto& [light, place] : lights) {
                const oracle::Arriving one = oracle::arrive(light, place, p, {0, 0, 1});
                sum += 0.8 * one.color * std::max(one.to_light.z, 0.0);
            }
            const Vec3 got = rgb_at(image, x, y);
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(got[c] - sum[c]) / (0.05 + sum[c]));
            }
            lit += sum.x > 0.01 ? 1 : 0;
        }
    }
    CHECK(lit > 1000);
    CHECK(worst < 4e-3);
}

TEST_CASE_FIXTURE(Scene, "clusters: a million lights are drawn, each where it reaches") {
    const Material matte = {
        .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}};
    place(add(make_square()), add(matte), affine_from({0, 0, 0}, {1, 0, 0, 0}, {60, 60, 1}));
    RandomLights random(33);
    const PointLight light = {.intensity = 0.02f, .radius = 0.5f};
    std::vector<Vec3> places;
    for (int i = 0; i < 1000000; ++i) {
        Vec3 p = random.in_cube(50);
        p.z = 0.25f;
        places.push_back(p);
        shine(light, at(p));
    }
    // Straight down at 20 x 20 m of it.
    const RenderView view = look({0, 0, 10}, {0, 0, 0}, 64, 64);
    const FrameOutput frame = draw(view);
    CHECK(frame.statistics.lights == 1000000);
    const gpu::FloatImage image = gpu::read_floats(*frame.radiance);
    for (const float value : image.pixels) {
        REQUIRE(std::isfinite(value));
    }
    for (int i = 0; i < 16; ++i) {
        const int x = 4 * i + 1;
        const int y = 61 - 3 * i;
        const glm::dvec3 p = {(x + 0.5) / 3.2 - 10, 10 - (y + 0.5) / 3.2, 0};
        double sum = 0;
        for (const Vec3& place : places) {
            if (glm::distance(glm::dvec3(place), p) < 0.5) {
                const oracle::Arriving one = oracle::arrive(light, place, p, {0, 0, 1});
                sum += one.color.x * one.to_light.z;
            }
        }
        CHECK(sum > 0);
        CHECK(image.at(x, y, 0) == test::near(sum).epsilon(4e-3));
    }
}

}  // namespace limn::test::cluster_test
