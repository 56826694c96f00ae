#include "content/load/gltf/gltf_load.h"
#include "ecs/components/humanoid.h"
#include "tests/app/run_program.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace limn::make_command_test {

using test::count_lines;
using test::near;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;

TEST_CASE("make: a person becomes a .glb with a skin, 60 joints of a body, clips and materials") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"make", "person", "--parts", "--set", "height=1.8", "--set", "seed=7", "--set",
                 "hair=short", "-o", "person.glb"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(run.out.starts_with("person.glb: 6 meshes, "));
    CHECK(run.out.find(", 60 joints, 6 clips") != std::string::npos);
    const Result<GltfScene> scene = load_gltf(folder.file("person.glb"));
    REQUIRE(scene);
    CHECK(scene->meshes.size() == 6);
    CHECK(scene->materials.size() == 6);
    CHECK(scene->skins.size() == 1);
    CHECK(scene->clips.size() == 6);
    CHECK(find_body_joints(scene->skeleton).has(BodyPart::LeftToes));
    const Bounds box = find_bounds(*scene);
    CHECK(box.min.y == near(0).scale(1).epsilon(2e-3));
    CHECK(box.max.y == near(1.8).epsilon(0.02));
    for (const MeshData& mesh : scene->meshes) {
        CHECK(!mesh.uvs.empty());
        CHECK(!mesh.colors.empty());
        CHECK(mesh.skin.first.size() == mesh.positions.size() + 1);
    }
}

TEST_CASE("export: a person opens again with its materials, skin and shapes, and speaks") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(
        folder, {"export", "person", "--set", "seed=7", "--set", "hair=long", "-o", "p.glb"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(run.out == "p.glb: 6 meshes, 16 shapes\n");
    const Result<GltfScene> scene = load_gltf(folder.file("p.glb"));
    REQUIRE(scene);
    CHECK(scene->warnings.empty());
    CHECK(scene->skins.size() == 1);
    CHECK(scene->clips.size() == 6);
    REQUIRE(scene->materials.size() == 6);
    for (const Material& material : scene->materials) {
        CAPTURE(material.name);
        CHECK((material.shading == ShadingModel::Subsurface) == (material.name == "skin"));
        CHECK((material.shading == ShadingModel::Hair) == (material.name == "hair"));
        CHECK((material.sheen.x > 0) == (material.name == "shirt" || material.name == "trousers"));
    }
    const MeshData& skin = scene->meshes[0];
    REQUIRE(skin.morphs.size() == 16);
    CHECK(skin.morphs[0].name == "bend LeftForearm");
    CHECK(skin.morphs[8].action_unit == "AU26");
    CHECK(!skin.morphs[8].positions.empty());
    const ProgramRun spoken =
        run_limn(folder, {"speak", "Hello", "--face", "p.glb", "--silent", "-o", "s.glb"});
    CAPTURE(spoken.err);
    REQUIRE(spoken.exit_code == 0);
    const Result<GltfScene> speaks = load_gltf(folder.file("s.glb"));
    REQUIRE(speaks);
    REQUIRE(!speaks->clips.empty());
    CHECK(speaks->clips[0].name == "speech");
    // The jaw falls in the clip, and the materials are still there.
    float jaw = 0;
    for (const ClipSheet& sheet : speaks->clips[0].sheets) {
        for (std::size_t k = 0; k < sheet.weights.size(); ++k) {
            jaw = std::max(
                jaw, sheet.morphing[k % sheet.morphing.size()] == 8 ? sheet.weights[k] : 0.0f);
        }
    }
    CHECK(jaw > 0.1f);
    CHECK(speaks->materials[0].shading == ShadingModel::Subsurface);
    const ProgramRun head = run_limn(folder, {"export", "head", "--set", "seed=7", "-o", "h.glb"});
    CHECK(head.exit_code == 1);
    CHECK(head.err.find("expected a person") != std::string::npos);
}

TEST_CASE("make: a mesh without a skeleton; morph targets are written, too") {
    const TemporaryFolder folder;
    const ProgramRun box =
        run_limn(folder, {"make", "box", "--set", "size=[1,2,3]", "-o", "b.glb"});
    REQUIRE(box.exit_code == 0);
    CHECK(box.out == "b.glb: 1 meshes, 12 triangles\n");
    const ProgramRun fox =
        run_limn(folder, {"make", "creature", "--set", "detail=0.02", "-o", "fox.glb"});
    CAPTURE(fox.err);
    REQUIRE(fox.exit_code == 0);
    const Result<GltfScene> scene = load_gltf(folder.file("fox.glb"));
    REQUIRE(scene);
    CHECK(scene->meshes[0].morphs.size() == 2);
    CHECK(scene->clips.size() == 4);
}

TEST_CASE("make: what cannot be made is one line, and no file") {
    const TemporaryFolder folder;
    const auto check_fails = [&](const std::vector<std::string>& words, const char* says) {
        std::vector<std::string> all = {"make"};
        all.insert(all.end(), words.begin(), words.end());
        const ProgramRun run = run_limn(folder, all);
        CAPTURE(run.err);
        CHECK(run.exit_code == 1);
        CHECK(count_lines(run.err) == 1);
        CHECK(run.err.find(says) != std::string::npos);
        CHECK(!std::filesystem::exists(folder.file("a.glb")));
    };
    check_fails({"persn", "-o", "a.glb"}, "did you mean person?");
    check_fails({"person", "-o", "a.obj"}, "expected a file name ending in .glb");
    check_fails({"person", "--set", "hieght=2", "-o", "a.glb"}, "height");
    check_fails({"person", "--set", "height=20", "-o", "a.glb"}, "0 .. 10");
    check_fails({"box", "--parts", "-o", "a.glb"}, "has no parts");
    check_fails({"simplified", "-o", "a.glb"}, "empty");
}

}  // namespace limn::make_command_test
