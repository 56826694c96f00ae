// Editing furrows without a window: picking, dragging, steps, files.

#include "content/app/panels/furrow_edits.h"
#include "content/app/panels/undo.h"
#include "content/bake/furrow_field.h"
#include "content/bake/furrow_presets.h"
#include "content/bake/furrow_skin.h"
#include "content/make/patterns/furrow_patterns.h"
#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "ecs/components/camera.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "render/render_view.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace limn::test::furrow_edits_test {
namespace {

constexpr float kLength = 0.02f;  // of a vector of magnitude 1 [m]

/// The tube from the front, at 1280 x 720.
struct Seen {
    MeshData mesh = make_furrow_surface(FurrowSurface::Limb);
    ViewedMesh viewed;

    Seen() {
        const RenderView view = make_render_view(
            Camera{}, look_at({0.1f, 0.1f, 1.2f}, {0, 0, 0}), look_at({0, 0, 1}, {0, 0, 0}));
        viewed = {&mesh, view.unjittered_from_world, {0.1f, 0.1f, 1.2f}, {view.width, view.height}};
    }
};

/// A tube with furrows, as the editor finds it.
struct Edited {
    World world;
    Entity entity;

    Edited() {
        Assets assets;
        assets.meshes.push_back(make_furrow_surface(FurrowSurface::Limb));
        ImageData image;
        image.name = "normals";
        image.width = image.height = 64;
        assets.images.push_back(image);
        world.insert_resource(std::move(assets));
        entity = world.create(
            Furrows{.normals = {0}, .arrows = {{{0, 0, 0.2f}, {0.1f, 1, 0}, {1, 0, 0}}}},
            MeshInstance{{0}, {}});
        update();
    }
    void update() { world.run(update_furrow_skins); }
    Furrows& furrows() { return world.get<Furrows>(entity); }
    const FurrowSkin& skin() { return *std::as_const(world).find<FurrowSkin>(entity); }
    const MeshData& mesh() { return world.resource<Assets>().meshes[0]; }
    std::uint64_t noiseless_hash() {
        const std::vector<float>& height = skin().growth.height;
        return hash_bytes(height.data(), height.size() * sizeof(float));
    }
};

Vec3 random_unit(Random& random) {
    for (;;) {
        const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        if (const float length = glm::length(v); length > 0.1f && length < 1) {
            return v / length;
        }
    }
}

}  // namespace

TEST_CASE(
    "furrow edits: a pixel's ray goes through the point visible there"
    * technique("wrinkle.furrow.editor")) {
    const Seen tube;
    for (std::size_t v = 0; v < tube.mesh.positions.size(); v += 7) {
        const Vec3& p = tube.mesh.positions[v];
        const Ray ray = ray_of(tube.viewed, *pixel_of(tube.viewed, p));
        CHECK(glm::length(glm::cross(p - ray.origin, ray.direction)) < 1e-5f);
    }
    CHECK_FALSE(pixel_of(tube.viewed, {0, 0, 5}).has_value());  // behind the camera
}

TEST_CASE(
    "furrow edits: picking returns the nearest front-facing vertex within 6 px, none beyond"
    * technique("wrinkle.furrow.editor")) {
    const Seen tube;
    Random random(1, 2, 3, 4);
    int picked = 0;
    int missed = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec2 pointer(random.uniform(500, 780), random.uniform(20, 700));
        std::vector<float> front;  // distances of front vertices [px]
        for (std::size_t v = 0; v < tube.mesh.positions.size(); ++v) {
            const Vec3& p = tube.mesh.positions[v];
            const bool faces = glm::dot(tube.mesh.normals[v], tube.viewed.eye - p) > 0;
            front.push_back(faces ? glm::distance(*pixel_of(tube.viewed, p), pointer) : INFINITY);
        }
        const float least = *std::ranges::min_element(front);
        const auto found = pick_furrow_vertex(tube.viewed, pointer);
        CHECK(found.has_value() == (least <= kFurrowPickRadius));
        if (found) {
            CHECK(front[*found] == least);
        }
        picked += found ? 1 : 0;
        missed += found ? 0 : 1;
    }
    CHECK(picked > 20);
    CHECK(missed > 20);
}

TEST_CASE(
    "furrow edits: back-facing and occluded vertices are not picked"
    * technique("wrinkle.furrow.editor")) {
    Seen tube;
    const std::uint32_t front = *pick_furrow_vertex(tube.viewed, {640, 360}, 40);
    CHECK(tube.mesh.positions[front].z > 0);
    // The same vertex behind a triangle that stands before it, and turned away.
    const Vec3 at = tube.mesh.positions[front];
    MeshData hidden = tube.mesh;
    const auto first = static_cast<std::uint32_t>(hidden.positions.size());
    for (const Vec3& corner : {Vec3(-9, -9, 0.6f), Vec3(9, -9, 0.6f), Vec3(0, 9, 0.6f)}) {
        hidden.positions.push_back(corner);
        hidden.normals.emplace_back(0, 0, 1);
    }
    hidden.indices.insert(hidden.indices.end(), {first, first + 1, first + 2});
    tube.viewed.mesh = &hidden;
    const Vec2 pointer = *pixel_of(tube.viewed, at);
    CHECK_FALSE(pick_furrow_vertex(tube.viewed, pointer).has_value());
    MeshData turned = tube.mesh;
    for (Vec3& n : turned.normals) {
        n = -n;
    }
    tube.viewed.mesh = &turned;
    const auto found = pick_furrow_vertex(tube.viewed, pointer);
    CHECK((!found || turned.positions[*found].z < 0));
}

TEST_CASE(
    "furrow edits: of two tips the nearer one is taken, none beyond 6 px"
    * technique("wrinkle.furrow.editor")) {
    const Seen tube;
    const std::uint32_t v = *pick_furrow_vertex(tube.viewed, {640, 360}, 40);
    const Vec3& p = tube.mesh.positions[v];
    const FurrowVectors vectors = {Vec3(0, 1.5f, 0), Vec3(1.5f, 0, 0)};
    for (int f = 0; f < 2; ++f) {
        const Vec2 tip = *pixel_of(tube.viewed, p + kLength * vectors[static_cast<std::size_t>(f)]);
        CHECK(pick_furrow_tip(tube.viewed, p, vectors, kLength, tip + Vec2(3, 3)) == f);
        CHECK_FALSE(
            pick_furrow_tip(tube.viewed, p, vectors, kLength, tip + Vec2(5, 5)).has_value());
        // A tip that is drawn larger, of an image with few rows.
        CHECK(pick_furrow_tip(tube.viewed, p, vectors, kLength, tip + Vec2(5, 5), 8) == f);
    }
}

TEST_CASE(
    "furrow edits: a dragged vector is tangent, at most 2 long, with its tip under the ray"
    * technique("wrinkle.furrow.editor")) {
    Random random(5, 6, 7, 8);
    int clamped = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p = random_unit(random);
        const Vec3 n = random_unit(random);
        const Ray ray = {p + 2.0f * random_unit(random), random_unit(random)};
        const Vec3 d = drag_furrow_tip(p, n, kLength, ray);
        REQUIRE(std::abs(glm::dot(d, n)) < 1e-4f);
        REQUIRE(glm::length(d) <= 2.00001f);
        clamped += glm::length(d) > 1.999f ? 1 : 0;
        // Toward a point of the plane that is near enough.
        const Vec3 tangent = random_unit(random);
        const Vec3 wanted = 1.5f * (tangent - glm::dot(tangent, n) * n);
        const Vec3 tip = p + kLength * wanted;
        const Vec3 eye = tip + n + 0.5f * random_unit(random);
        const Vec3 found = drag_furrow_tip(p, n, kLength, {eye, glm::normalize(tip - eye)});
        CHECK(glm::distance(found, wanted) < 1e-3f);
    }
    CHECK(clamped > 500);
    // Seen edge on, a vector still follows what it can.
    const Vec3 d = drag_furrow_tip({0, 0, 0}, {0, 1, 0}, 1, {{1, 0, 5}, {0, 0, -1}});
    CHECK(glm::distance(d, Vec3(1, 0, 0)) < 1e-5f);
}

TEST_CASE(
    "furrow edits: an edited vertex keeps one arrow, which begins with what is shown there"
    * technique("wrinkle.furrow.editor")) {
    Edited tube;
    const std::uint32_t v = 40;
    const FurrowVectors shown = tube.skin().field[v];
    edit_furrow_vertex(tube.furrows(), tube.skin(), tube.mesh(), v);
    REQUIRE(tube.furrows().arrows.size() == 2);
    CHECK(tube.furrows().arrows[1].first == shown[0]);
    CHECK(tube.furrows().arrows[1].second == shown[1]);
    CHECK(tube.furrows().arrows[1].weight == 1);
    tube.update();
    FurrowArrow& again = edit_furrow_vertex(tube.furrows(), tube.skin(), tube.mesh(), v);
    CHECK(tube.furrows().arrows.size() == 2);
    again.weight = 3;
    CHECK(tube.furrows().arrows[1].weight == 3);
    // Its twin across the seam of the texture is at the same position.
    const std::uint32_t twin[2] = {33 * 5, 33 * 5 + 32};
    REQUIRE(glm::distance(tube.mesh().positions[twin[0]], tube.mesh().positions[twin[1]]) < 1e-6f);
}

TEST_CASE(
    "furrow edits: initialize brings back the fields of an unedited mesh"
    * technique("wrinkle.furrow.editor")) {
    for (const bool waits : {false, true}) {
        Edited tube;
        let_furrows_wait(tube.furrows(), waits);
        initialize_furrows(tube.furrows());
        tube.update();
        for (std::size_t v = 0; v < tube.mesh().positions.size(); ++v) {
            REQUIRE(tube.skin().field[v] == initial_furrow_vectors(tube.mesh().normals[v]));
        }
    }
}

TEST_CASE(
    "furrow edits: each step builds on the result of the previous one alone"
    * technique("wrinkle.furrow.editor")) {
    Edited tube;
    let_furrows_wait(tube.furrows(), true);
    tube.update();
    const std::uint64_t grown = tube.noiseless_hash();
    const std::vector<float> height = tube.skin().height;
    edit_furrow_vertex(tube.furrows(), tube.skin(), tube.mesh(), 200).first = {0, 2, 0};
    tube.furrows().style.noise = 0.4f;
    tube.furrows().style.scale = 2;

    generate_furrows(tube.furrows());  // along the fields as they are
    CHECK(tube.furrows().hold.grown.size() == 1);
    let_furrows_wait(tube.furrows(), false);
    let_furrows_wait(tube.furrows(), true);
    tube.furrows().style.noise = 0.2f;
    tube.update();
    const std::uint64_t scaled = tube.noiseless_hash();
    const std::vector<float> before = tube.skin().height;
    CHECK(scaled != grown);

    tube.furrows().style.scale = 1;
    remake_furrows(tube.furrows());
    tube.update();
    CHECK(tube.noiseless_hash() == scaled);  // REMAKE changes no noiseless height
    CHECK(tube.skin().height != before);
    generate_furrows(tube.furrows());
    tube.update();
    CHECK(tube.noiseless_hash() != scaled);
}

TEST_CASE(
    "furrow edits: undo and redo of a dragged tip restore furrows to the bit"
    * technique("wrinkle.furrow.editor")) {
    Edited tube;
    UndoStack undo;
    const std::uint64_t before = tube.noiseless_hash();
    const Furrows old = tube.furrows();
    Furrows edited = old;
    edit_furrow_vertex(edited, tube.skin(), tube.mesh(), 300).second = {0, 1.7f, 0};
    Edit edit;
    edit.entity = tube.entity;
    edit.before = AnyComponent::of(old);
    edit.after = AnyComponent::of(edited);
    apply_edit_value(tube.world, edit, edit.after);
    undo.record(std::move(edit));
    tube.update();
    const std::uint64_t after = tube.noiseless_hash();
    CHECK(after != before);
    undo.undo(tube.world);
    tube.update();
    CHECK(tube.noiseless_hash() == before);
    undo.redo(tube.world);
    tube.update();
    CHECK(tube.noiseless_hash() == after);
}

TEST_CASE(
    "furrow edits: the ranges and defaults of sliders are those of the editor of 2001"
    * technique("wrinkle.furrow.editor")) {
    struct Range {
        const ComponentInfo& info;
        const char* field;
        double min, max;
    };
    const Range ranges[] = {
        {component_info<FurrowArrow>(), "weight", 0, 10},
        {component_info<FurrowStyle>(), "scale", 0.5, 2},
        {component_info<FurrowStyle>(), "noise", 0, 1},
        {component_info<FurrowStyle>(), "bump", 0, 1},
        {component_info<FurrowLook>(), "melanin", 0, 1},
        {component_info<FurrowLook>(), "blood", 0, 1},
        {component_info<FurrowLook>(), "specular", 0, 1},
        {component_info<FurrowLook>(), "shininess", 0, 128},
    };
    for (const Range& range : ranges) {
        CAPTURE(range.field);
        bool found = false;
        for (const FieldInfo& field : range.info.fields) {
            if (std::string(field.name) == range.field) {
                found = true;
                CHECK(field.meta.min == range.min);
                CHECK(field.meta.max == range.max);
            }
        }
        CHECK(found);
    }
    CHECK(FurrowArrow{}.weight == 1);
}

TEST_CASE(
    "furrow edits: the look of skin survives a round trip through its material"
    * technique("wrinkle.furrow.editor")) {
    for (const FurrowReflection reflection :
         {FurrowReflection::Own, FurrowReflection::Brdf1, FurrowReflection::Brdf2}) {
        const FurrowLook look = {reflection, 0.3f, 0.6f, 0.25f, 70};
        Material material;
        set_furrow_look(material, look);
        CHECK(furrow_look_of(material) == look);
        CHECK(
            (material.shading == ShadingModel::Lafortune) == (reflection != FurrowReflection::Own));
        CHECK(material.lobes.size() == (reflection == FurrowReflection::Own ? 0 : 2));
    }
}

TEST_CASE(
    "furrow edits: the rough figure needs no new furrows after the smooth one"
    * technique("wrinkle.furrow.editor")) {
    Edited tube;
    FurrowLook look;
    for (const FurrowPreset& preset : furrow_presets()) {
        if (std::string(preset.figure) == "6.6a" || std::string(preset.figure) == "6.6b") {
            set_furrow_preset(tube.furrows(), look, preset);
            tube.update();
            CHECK(look.specular == preset.specular);
        }
        if (std::string(preset.figure) == "6.6a") {
            const std::uint64_t smooth = tube.noiseless_hash();
            set_furrow_preset(tube.furrows(), look, *(&preset + 1));
            tube.update();
            CHECK(tube.noiseless_hash() == smooth);
        }
    }
}

TEST_CASE(
    "furrow edits: a saved file loads back to the bit, and grows the same furrows"
    * technique("wrinkle.furrow.editor")) {
    Edited tube;
    const TemporaryFolder folder;
    FurrowFile file;
    file.furrows.arrows = tube.furrows().arrows;
    file.furrows.arrows.push_back({{0.1f, 1.0f / 3.0f, -0.7f}, {1e-7f, 1.9f, 0}, {0, 0, 0}, 9.7f});
    file.furrows.style = {.scale = 1.1f, .noise = 0.3f, .bump = 0.7f, .seed = 12};
    file.furrows.tiles = true;
    file.skin = {FurrowReflection::Brdf2, 0.1f, 0.2f, 0.3f, 99};
    const std::string path = folder.file("hand.furrows.json");
    REQUIRE(save_furrows(path, file).ok());
    const auto loaded = load_furrows(path);
    REQUIRE_MESSAGE(loaded.ok(), (loaded ? "" : loaded.error().message));
    CHECK(*loaded == file);
    const auto grow = [&](const Furrows& furrows) {
        tube.furrows().arrows = furrows.arrows;
        tube.furrows().style = furrows.style;
        tube.update();
        return tube.noiseless_hash();
    };
    CHECK(grow(loaded->furrows) == grow(file.furrows));
}

TEST_CASE("furrow editor: files of before its BRDFs were renamed are read") {
    const TemporaryFolder folder;
    const std::string path = folder.file("old.json");
    for (const auto& [name, reflection] :
         {std::pair("measured_1", FurrowReflection::Brdf1),
          std::pair("measured_2", FurrowReflection::Brdf2)}) {
        std::ofstream(path) << R"({"furrows": {}, "skin": {"reflection": ")" << name << R"("}})";
        const auto loaded = load_furrows(path);
        REQUIRE(loaded.ok());
        CHECK(loaded->skin.reflection == reflection);
    }
}

TEST_CASE(
    "furrow edits: an invalid file is refused with its position"
    * technique("wrinkle.furrow.editor")) {
    const TemporaryFolder folder;
    const std::string path = folder.file("bad.json");
    struct Case {
        const char* text;
        const char* expected;
    };
    const Case cases[] = {
        {"{\"furrows\": {\"scale\": 9}}", "scale"},
        {"{\"furrows\": {\"arrows\": [{\"weight\": 11}]}}", "weight"},
        {"{\"furows\": {}}", "furrows"},
        {"{\"skin\": {\"reflection\": \"brdf_3\"}}", "brdf"},
        {"[1]", "object"},
    };
    for (const Case& it : cases) {
        std::ofstream(path) << it.text;
        const auto loaded = load_furrows(path);
        REQUIRE_FALSE(loaded.ok());
        CAPTURE(loaded.error().message);
        CHECK(loaded.error().message.find("bad.json:1:") != std::string::npos);
        CHECK(loaded.error().message.find(it.expected) != std::string::npos);
    }
    CHECK_FALSE(load_furrows(folder.file("absent.json")).ok());
}

}  // namespace limn::test::furrow_edits_test
