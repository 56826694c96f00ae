#include "render/lens/lens_flare_pass.h"
#include "render/lens/lens_ghosts.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <set>

namespace limn::test::lens_flare_test {
namespace {

// ---- a lens, surface by surface, in textbook signs: light that goes back has a negative index

struct OracleStep {
    int surface = 0;
    bool reflects = false;
};

/// The surfaces that light meets, in order; without a pair, of light that is not reflected.
std::vector<OracleStep> path_of(int near, int far) {
    const int count = static_cast<int>(double_gauss().size());
    std::vector<OracleStep> path;
    for (int i = 0; i < (far > 0 ? far : count); ++i) {
        path.push_back({i});
    }
    if (far > 0) {
        path.push_back({far, true});
        for (int i = far - 1; i > near; --i) {
            path.push_back({i});
        }
        path.push_back({near, true});
        for (int i = near + 1; i < count; ++i) {
            path.push_back({i});
        }
    }
    return path;
}

double vertex_of(int surface) {
    double z = 0;
    for (int i = 0; i < surface; ++i) {
        z += double_gauss()[i].thickness;
    }
    return z;
}

double index_before(int surface) {
    return surface > 0 ? double_gauss()[surface - 1].index : 1.0;
}

struct Traced {
    double sensor = 0;
    std::vector<double> stop;
    bool lost = false;
};

/// The paraxial y-nu trace: n' u' = n u - y (n' - n) / R, y' = y + (t / n') n' u'.
Traced trace_paraxial(const std::vector<OracleStep>& path, double y, double u, double sensor) {
    Traced traced;
    double n = 1;
    double z = 0;
    for (const auto& [surface, reflects] : path) {
        const LensSurface& s = double_gauss()[surface];
        y += (vertex_of(surface) - z) * u;
        z = vertex_of(surface);
        if (s.radius == 0) {
            traced.stop.push_back(y);
            continue;
        }
        const double next = reflects ? -n : n > 0 ? s.index : -index_before(surface);
        u = (n * u - y * (next - n) / s.radius) / next;
        n = next;
    }
    traced.sensor = y + (sensor - z) * u;
    return traced;
}

/// A real ray in the plane x = 0, by Snell's law at spheres.
Traced trace_real(const std::vector<OracleStep>& path, double y, double u, double sensor) {
    Traced traced;
    glm::dvec2 at = {0, y};  // z, y
    glm::dvec2 toward = glm::normalize(glm::dvec2(1, u));
    double n = 1;
    for (const auto& [surface, reflects] : path) {
        const LensSurface& s = double_gauss()[surface];
        const double vertex = vertex_of(surface);
        if (s.radius == 0) {
            at += toward * ((vertex - at.x) / toward.x);
            traced.stop.push_back(at.y);
            continue;
        }
        const glm::dvec2 middle = {vertex + s.radius, 0};
        const double b = glm::dot(at - middle, toward);
        const double c = glm::dot(at - middle, at - middle) - s.radius * s.radius;
        const double root = std::sqrt(b * b - c);
        const glm::dvec2 hits[] = {at + toward * (-b - root), at + toward * (-b + root)};
        at = std::abs(hits[0].x - vertex) < std::abs(hits[1].x - vertex) ? hits[0] : hits[1];
        glm::dvec2 normal = glm::normalize(at - middle);
        normal *= glm::dot(normal, toward) > 0 ? -1.0 : 1.0;
        if (reflects) {
            toward = glm::reflect(toward, normal);
            continue;
        }
        const double next = toward.x > 0 ? s.index : index_before(surface);
        toward = glm::refract(toward, normal, n / next);
        traced.lost |= toward == glm::dvec2(0);
        n = next;
    }
    traced.sensor = at.y + toward.y * (sensor - at.x) / toward.x;
    return traced;
}

double sensor_place() {
    const auto lens = double_gauss();
    return vertex_of(static_cast<int>(lens.size()) - 1) + focus_of(lens).image_distance;
}

}  // namespace

TEST_CASE("lens flare: the double Gauss has the focal length of its patent") {
    const LensFocus focus = focus_of(double_gauss());
    CHECK(focus.focal_length == near(50).epsilon(0.01));
    for (const double y : {0.5, 3.0}) {
        const double slope = 0.01;
        const Traced traced = trace_paraxial(path_of(0, 0), y, slope, sensor_place());
        CHECK(traced.sensor == near(slope * focus.focal_length).epsilon(1e-10));
        CHECK(
            traced.stop.at(0)
            == near(focus.stop.height * y + focus.stop.slope * slope).epsilon(1e-10));
    }
}

TEST_CASE(
    "lens flare: the matrices of all ghosts equal a ray trace surface by surface"
    * technique("engine.lens-flare")) {
    const std::vector<LensGhost> ghosts = make_lens_ghosts(double_gauss(), {});
    CHECK(ghosts.size() == 10 * 9 / 2);
    std::set<std::pair<int, int>> pairs;
    for (const LensGhost& ghost : ghosts) {
        CAPTURE(ghost.near);
        CAPTURE(ghost.far);
        pairs.insert({ghost.near, ghost.far});
        for (const auto& [y, u] :
             {std::pair(1.0, 0.0), std::pair(0.0, 0.1), std::pair(2.0, -0.3)}) {
            const Traced traced =
                trace_paraxial(path_of(ghost.near, ghost.far), y, u, sensor_place());
            CHECK(
                ghost.sensor.height * y + ghost.sensor.slope * u
                == near(traced.sensor).epsilon(1e-9).scale(1));
            REQUIRE(traced.stop.size() == ghost.passages);
            CHECK(ghost.passages == (ghost.near < 5 && ghost.far > 5 ? 3 : 1));
            for (int i = 0; i < ghost.passages; ++i) {
                CHECK(
                    ghost.stop[i].height * y + ghost.stop[i].slope * u
                    == near(traced.stop[i]).epsilon(1e-9).scale(1));
            }
        }
    }
    CHECK(pairs.size() == ghosts.size());
}

TEST_CASE(
    "lens flare: real rays converge to the matrices, with the square of the angle"
    * technique("engine.lens-flare")) {
    for (const LensGhost& ghost : make_lens_ghosts(double_gauss(), {})) {
        CAPTURE(ghost.near);
        CAPTURE(ghost.far);
        double errors[2];
        for (int i = 0; i < 2; ++i) {
            const double small = i == 0 ? 2e-3 : 1e-3;
            const double y = 20 * small;
            const Traced traced =
                trace_real(path_of(ghost.near, ghost.far), y, small, sensor_place());
            REQUIRE_FALSE(traced.lost);
            const double paraxial = ghost.sensor.height * y + ghost.sensor.slope * small;
            const double size =
                std::abs(ghost.sensor.height * y) + std::abs(ghost.sensor.slope * small);
            errors[i] = std::abs(traced.sensor - paraxial) / size;
        }
        CHECK(errors[1] < 1e-3);
        CHECK(errors[1] < 0.3 * errors[0] + 1e-9);  // a quarter
    }
}

TEST_CASE("lens flare: a quarter-wave layer reflects least at its wavelength, as closed forms do") {
    const double n1 = 1.38;
    const double n2 = 1.67;
    const double least = (n2 - n1 * n1) / (n2 + n1 * n1);
    CHECK(coated_reflectance(1, n1, n2, 550, 550) == near(least * least).epsilon(1e-12));
    const double bare = (n2 - 1) * (n2 - 1) / ((n2 + 1) * (n2 + 1));
    CHECK(coated_reflectance(1, n1, n2, 0, 550) == near(bare).epsilon(1e-12));
    CHECK(coated_reflectance(1, n1, n2, 550, 275) == near(bare).epsilon(1e-12));  // half a wave
    CHECK(coated_reflectance(1, std::sqrt(n2), n2, 550, 550) == near(0).scale(1).epsilon(1e-12));
    for (const double wavelength : {450.0, 500.0, 620.0, 700.0}) {
        const double reflected = coated_reflectance(1, n1, n2, 550, wavelength);
        CHECK(reflected > least * least);
        CHECK(reflected < bare);
        CHECK(reflected == near(coated_reflectance(n2, n1, 1, 550, wavelength)).epsilon(1e-12));
    }
}

TEST_CASE("lens flare: a ghost's strength is two reflectances and the transmittances between") {
    for (const LensGhost& ghost : make_lens_ghosts(double_gauss(), {.wavelength = 0})) {
        const auto reflected = [](int i) {
            const double n = double_gauss()[i].index;
            return square((n - index_before(i)) / (n + index_before(i)));
        };
        double strength = 1;
        double direct = 1;
        for (const auto& [surface, reflects] : path_of(ghost.near, ghost.far)) {
            strength *= reflects ? reflected(surface) : 1 - reflected(surface);
        }
        for (const auto& [surface, reflects] : path_of(0, 0)) {
            direct *= 1 - reflected(surface);
        }
        CHECK(ghost.strength.y == near(strength / direct));
    }
    // Coated for green, it reflects red and blue: magenta.
    const LensGhost coated = make_lens_ghosts(double_gauss(), {.wavelength = 540})[0];
    CHECK(coated.strength.x > 1.1f * coated.strength.y);
    CHECK(coated.strength.z > 1.3f * coated.strength.y);
}

namespace {

constexpr float kTangent = 0.36f;

LensFlare ghosts_kept(int count) {
    return {.f_number = 8, .ghosts = count};
}

/// Integral over the image of what a sprite adds, as lens_flare.frag draws a polygon of `blades`.
double light_of(const FlareSprite& sprite, int blades) {
    constexpr int kSteps = 160;
    std::vector<glm::dvec2> edges;  // normals of the polygon over the radius of its inner circle
    for (int k = 0; k < blades; ++k) {
        const double angle =
            LensFlare{}.blade_rotation + glm::radians(180.0 * (2 * k + 1) / blades);
        edges.push_back(
            glm::dvec2(std::cos(angle), std::sin(angle)) / std::cos(glm::radians(180.0 / blades)));
    }
    double sum = 0;
    for (int y = 0; y < kSteps; ++y) {
        for (int x = 0; x < kSteps; ++x) {
            const glm::dvec2 at =
                glm::dvec2(sprite.center)
                + double(sprite.radius) * ((glm::dvec2(x, y) + 0.5) * (2.0 / kSteps) - 1.0);
            double passed = 1;
            for (const Vec4& rim : sprite.rims) {
                const glm::dvec2 q = double(rim.x) * at + glm::dvec2(rim.y, rim.z);
                double r = rim.w == 1 ? 0 : glm::length(q);
                for (std::size_t k = 0; k < edges.size() && rim.w == 1; ++k) {
                    r = std::max(r, glm::dot(q, edges[k]));
                }
                const double soft = std::max(1e-9, sprite.softness * std::abs(double(rim.x)));
                const double t = std::clamp((r - 1 + soft) / (2 * soft), 0.0, 1.0);
                passed = rim.w < 0 ? passed : std::min(passed, 1 - t * t * (3 - 2 * t));
            }
            sum += passed;
        }
    }
    return sum * square(2.0 * sprite.radius / kSteps) * sprite.radiance.y;
}

}  // namespace

TEST_CASE(
    "lens flare: a ghost's light is that entering the lens times the ghost's strength"
    * technique("engine.lens-flare")) {
    // From the axis, all rims are concentric and the tightest one decides what enters; at f/8 no
    // two are so alike that the corners of one are outside the other. The pupil gathers pi / (4
    // N^2) of the light, and the scene is exposed by as much, which cancels.
    const LensFlare flare = ghosts_kept(64);
    const LensFocus focus = focus_of(double_gauss());
    const double pupil = focus.focal_length / (2.0 * flare.f_number);
    std::vector<double> expected;
    for (const LensGhost& ghost : make_lens_ghosts(
             double_gauss(), {.wavelength = flare.coating, .spread = flare.coating_spread})) {
        double entered = 0.5 * double_gauss()[0].diameter;
        for (int i = 0; i < ghost.passages; ++i) {
            entered = std::min(entered, pupil * std::abs(focus.stop.height / ghost.stop[i].height));
        }
        expected.push_back(ghost.strength.y * square(entered / pupil));
    }
    std::vector<double> found;
    const FlareLight light = {.tangent = {0, 0}, .illuminance = {2, 2, 2}};
    for (const FlareSprite& sprite : make_flare_sprites(flare, light, kTangent, 720)) {
        found.push_back(light_of(sprite, flare.blades) / 2);
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i] == near(expected[i]).epsilon(0.02));
    }
}

TEST_CASE("lens flare: ghosts are where traced rays image the center of the tightest rim") {
    const LensFlare flare = {.f_number = 8, .blades = 0, .ghosts = 64, .source_size = 0};
    const double f = focus_of(double_gauss()).focal_length;
    const double sensor = sensor_place();
    const double stop = focus_of(double_gauss()).stop.height * f / (2.0 * flare.f_number);
    const double tangent = 0.2;
    std::vector<std::pair<double, double>> expected;  // center and radius
    for (const LensGhost& ghost : make_lens_ghosts(double_gauss(), {})) {
        const auto path = path_of(ghost.near, ghost.far);
        // Light from the right goes to the left, and the image is upside down.
        const Traced low = trace_paraxial(path, 0, -tangent, sensor);
        const Traced high = trace_paraxial(path, 1, -tangent, sensor);
        double center = -low.sensor / f;
        double radius = std::abs(high.sensor - low.sensor) * 0.5 * double_gauss()[0].diameter / f;
        for (std::size_t i = 0; i < low.stop.size(); ++i) {
            const double per_height = high.stop[i] - low.stop[i];
            const double rim = std::abs((high.sensor - low.sensor) / per_height) * stop / f;
            const double through_center = -low.stop[i] / per_height;
            if (rim < radius) {
                radius = rim;
                center = -(low.sensor + through_center * (high.sensor - low.sensor)) / f;
            }
        }
        expected.emplace_back(center, radius);
    }
    std::vector<std::pair<double, double>> found;
    for (const FlareSprite& sprite : make_flare_sprites(
             flare, {.tangent = {tangent, 0}, .illuminance = {1, 1, 1}}, kTangent, 100000)) {
        CHECK(sprite.center.y == 0);
        found.emplace_back(sprite.center.x, sprite.radius - sprite.softness);
    }
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i].first == near(expected[i].first).scale(0.1));
        CHECK(found[i].second == near(expected[i].second).epsilon(1e-3).scale(0.01));
    }
}

TEST_CASE("lens flare: the brightest ghosts are kept, the same ones at any light position") {
    const FlareLight light = {.tangent = {0.2f, 0.1f}, .illuminance = {1, 1, 1}};
    const auto all = make_flare_sprites(ghosts_kept(64), light, kTangent, 720);
    const auto some = make_flare_sprites(ghosts_kept(7), light, kTangent, 720);
    REQUIRE(some.size() == 7);
    for (std::size_t i = 0; i < some.size(); ++i) {
        CHECK(some[i].radiance == all[i].radiance);
    }
    const auto moved = make_flare_sprites(
        ghosts_kept(7), {.tangent = {-0.1f, 0.3f}, .illuminance = {1, 1, 1}}, kTangent, 720);
    for (std::size_t i = 0; i < some.size(); ++i) {
        CHECK(moved[i].radiance == some[i].radiance);
        // Places are linear in that of the light.
        CHECK(moved[i].center.x == near(-0.5 * some[i].center.x));
        CHECK(moved[i].center.y == near(3.0 * some[i].center.y));
    }
    CHECK(make_flare_sprites(ghosts_kept(0), light, kTangent, 720).empty());
}

TEST_CASE(
    "lens flare: billboards lie on the line from the light through the center"
    * technique("engine.lens-flare")) {
    const LensFlare flare = {
        .mode = LensFlareMode::Billboards,
        .source_size = 0.02f,
        .elements = {{0, 0.1f}, {0.25f, 0.1f}, {0.5f, 0.1f}, {0.75f, 0.1f}, {1, 0.1f}}};
    const Vec2 position = {0.3f, -0.12f};
    const auto sprites_at = [&](const Vec2& tangent) {
        return make_flare_sprites(
            flare, {.tangent = tangent, .illuminance = {1, 1, 1}}, kTangent, 720);
    };
    const auto sprites = sprites_at(position);
    REQUIRE(sprites.size() == 5);
    const float expected[] = {1, 0.5f, 0, -0.5f, -1};
    const auto mirrored = sprites_at(-position);
    for (std::size_t i = 0; i < 5; ++i) {
        // As soft as the light is wide there, but by no less than three pixels.
        const float soft = std::max(std::abs(expected[i]) * 0.02f, 6.0f / 720);
        CHECK(sprites[i].softness == near(soft * kTangent));
        for (int axis = 0; axis < 2; ++axis) {
            CHECK(sprites[i].center[axis] == near(expected[i] * position[axis]).scale(1e-3));
            CHECK(mirrored[i].center[axis] == near(sprites[4 - i].center[axis]).scale(1e-3));
        }
    }
    for (const FlareSprite& sprite : sprites_at({0, 0})) {
        CHECK(sprite.center == Vec2(0));
    }
}

namespace {

/// A black world with the sun at `tangent` of the image.
struct FlareScene : Scene {
    FlareScene() {
        world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(0)});
        camera = world.create(LensFlare{}, WorldTransform{at({0, 0, 0})});
        view.entity = camera;
    }
    LensFlare& flare() { return *world.find<LensFlare>(camera); }

    Entity sun_at(const Vec2& tangent, float illuminance = 100) {
        const Vec3 toward = {tangent, -1};
        return shine(DirectionalLight{.illuminance = illuminance}, look_at(toward, {0, 0, 0}));
    }
    /// A black wall at z = -1 from `left` to the right border and beyond.
    Entity wall(float left) {
        const MaterialId black =
            add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}});
        return place(add(make_square()), black, at({left + 1, 0, -1}));
    }
    double light() {
        const gpu::FloatImage image = radiance(view);
        double sum = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                sum += image.at(x, y, 1);
            }
        }
        CHECK(std::isfinite(sum));
        return sum;
    }

    RenderView view = look({0, 0, 0}, {0, 0, -1}, 256, 192);
    Entity camera;
};

/// Center of what is bright [px from the left and the top].
glm::dvec2 center_of_light(const gpu::FloatImage& image) {
    glm::dvec2 sum = {0, 0};
    double all = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            sum += double(image.at(x, y, 1)) * glm::dvec2(x + 0.5, y + 0.5);
            all += image.at(x, y, 1);
        }
    }
    return sum / all;
}

}  // namespace

TEST_CASE_FIXTURE(
    FlareScene, "lens flare: ghosts are drawn at their computed positions, within a pixel"
                    * technique("engine.lens-flare")) {
    const Vec2 tangent = {0.35f, 0.2f};
    sun_at(tangent);
    const gpu::FloatImage none = [&] {
        flare().strength = 0;
        return radiance(view);
    }();
    flare() = {.f_number = 16, .source_size = 0};
    gpu::FloatImage before = none;
    int compared = 0;
    for (int count = 1; count <= 20; ++count) {
        flare().ghosts = count;
        const gpu::FloatImage now = radiance(view);
        gpu::FloatImage added = now;
        double sum = 0;
        for (std::size_t i = 0; i < now.pixels.size(); ++i) {
            added.pixels[i] = now.pixels[i] - before.pixels[i];
            sum += added.pixels[i];
        }
        before = now;
        const FlareSprite sprite =
            make_flare_sprites(
                flare(), {.tangent = tangent, .illuminance = Vec3(100)}, view.tangent.y, 192)
                .back();
        // Whole ghosts of one passage only: their center is that of their light.
        const Vec4& front = sprite.rims[0];
        const Vec2 extent = glm::abs(sprite.center) + sprite.radius;
        const bool whole = sprite.rims[2].w < 0 && extent.x < view.tangent.x
                           && extent.y < view.tangent.y
                           && glm::length(front.x * sprite.center + Vec2(front.y, front.z))
                                      + std::abs(front.x) * sprite.radius
                                  < 1;
        if (whole) {
            const Vec2 ndc = sprite.center / view.tangent;
            const glm::dvec2 expected = {128 * (1.0 + ndc.x), 96 * (1.0 - ndc.y)};
            CAPTURE(count);
            const glm::dvec2 found = center_of_light(added);
            CHECK(std::abs(found.x - expected.x) < 1);
            CHECK(std::abs(found.y - expected.y) < 1);
            CHECK(sum > 0);
            ++compared;
        }
    }
    CHECK(compared >= 4);
}

TEST_CASE_FIXTURE(
    FlareScene, "lens flare: an occluded light has none, a half occluded one half of it"
                    * technique("engine.lens-flare")) {
    const Vec2 tangent = {-0.3f, 0.25f};
    flare().source_size = 0.12f;
    flare().mode = LensFlareMode::Billboards;  // none of which is at the light itself
    flare().elements = {{0.6f, 0.2f, Vec3(0.01f)}, {0.7f, 0.1f, Vec3(0.01f)}};
    const Entity sun = sun_at(tangent);
    const Entity edge = wall(tangent.x);
    const double half = light();
    world.get<WorldTransform>(edge).world = at({0, 0, -1});
    const double hidden = light();
    world.get<WorldTransform>(edge).world = at({9, 0, -1});
    const double whole = light();
    CHECK(whole > 0);
    CHECK(hidden == 0);
    CHECK(half == near(0.5 * whole).epsilon(0.04));

    // Half out of the image, all out of it, behind the camera.
    world.destroy(sun);
    const float border = view.tangent.y;
    for (const auto& [y, part] : {std::pair(border, 0.5), {1.2f * border, 0.0}}) {
        const Entity other = sun_at({0, y});
        CHECK(light() == near(part * whole).epsilon(0.06).scale(1e-9));
        world.destroy(other);
    }
    shine(DirectionalLight{.illuminance = 100}, look_at({0.1f, 0, 1}, {0, 0, 0}));
    CHECK(light() == 0);
}

TEST_CASE_FIXTURE(
    FlareScene, "lens flare: a lamp is occluded by a wall, but not by its own glass") {
    flare().mode = LensFlareMode::Billboards;
    flare().elements = {{1.0f, 0.2f, Vec3(0.01f)}};
    world.create(PointLight{.intensity = 100}, WorldTransform{at({0.5f, 0.5f, -1.2f})});
    const double free = light();
    CHECK(free > 0);
    const Entity wall_before = wall(-1);
    CHECK(light() == near(free));
    flare().lamp_radius = 0.1f;
    CHECK(light() == 0);
    world.destroy(wall_before);
    // A spot that shines away.
    world.create(
        SpotLight{.intensity = 1000},
        WorldTransform{look_at({-0.5f, 0.5f, -2}, {-0.5f, 0.5f, -5})});
    CHECK(light() == near(free));
    world.create(
        SpotLight{.intensity = 1000}, WorldTransform{look_at({-0.5f, 0.5f, -2}, {0, 0, 0})});
    CHECK(light() > 2 * free);
}

TEST_CASE_FIXTURE(
    FlareScene, "lens flare: without it there is no pass, and no NaN with any settings") {
    sun_at({0.2f, 0.1f});
    flare().strength = 0;
    CHECK(light() == 0);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("lens flare"));
    for (const float bad : {NAN, INFINITY, -INFINITY, -1.0f, 0.0f, 1e30f}) {
        flare() = {
            .f_number = bad,
            .blades = -5,
            .blade_rotation = bad,
            .coating = bad,
            .coating_spread = bad,
            .ghosts = 1000,
            .source_size = bad,
            .lamp_radius = bad};
        (void)light();
        flare().mode = LensFlareMode::Billboards;
        flare().elements = {{bad, bad, Vec3(bad)}};
        (void)light();
    }
    flare() = {};
    CHECK(light() > 0);
    world.get<LensFlare>(camera).blades = 0;
    CHECK(light() > 0);
}

}  // namespace limn::test::lens_flare_test
