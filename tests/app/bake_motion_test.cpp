#include "content/load/gltf/gltf_load.h"
#include "content/load/motion/bvh_file.h"
#include "tests/app/run_program.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace limn::bake_motion_test {

using test::count_lines;
using test::near;
using test::ProgramRun;
using test::run_limn;
using test::TemporaryFolder;
using test::write_text;

namespace {

std::string leg(const std::string& side, int x) {
    const std::string turns = "CHANNELS 3 Zrotation Xrotation Yrotation ";
    return "JOINT " + side + "UpLeg { OFFSET " + std::to_string(x) + " -5 0 " + turns + "JOINT "
           + side + "Leg { OFFSET 0 -45 0 " + turns + "JOINT " + side + "Foot { OFFSET 0 -43 0 "
           + turns + "End Site { OFFSET 0 -7 15 } } } }\n";
}

/// A person who moves by 1 m in 50 frames with straight legs.
std::string make_bvh() {
    std::string text =
        "HIERARCHY\nROOT Hips { OFFSET 0 100 0\n"
        "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
        + leg("Left", 10) + leg("Right", -10)
        + "JOINT Spine { OFFSET 0 20 0 CHANNELS 3 Zrotation Xrotation Yrotation\n"
          "JOINT Head { OFFSET 0 40 0 CHANNELS 3 Zrotation Xrotation Yrotation } } }\n"
          "MOTION\nFrames: 51\nFrame Time: 0.02\n";
    for (int frame = 0; frame <= 50; ++frame) {
        text += "0 100 " + std::to_string(2 * frame);
        for (int value = 0; value < 27; ++value) {
            text += " 0";
        }
        text += '\n';
    }
    return text;
}

void check_fails(const ProgramRun& run, int code, const char* says) {
    CAPTURE(run.err);
    CHECK(run.exit_code == code);
    CHECK(count_lines(run.err) == 1);
    CHECK(run.err.find(says) != std::string::npos);
}

}  // namespace

TEST_CASE(
    "import: bvh becomes a .glb with a skeleton and a clip"
    * technique("char.bvh-format, char.mocap-rate")) {
    const TemporaryFolder folder;
    write_text(folder.file("walk.bvh"), make_bvh());
    ProgramRun run = run_limn(folder, {"import", "bvh", "walk.bvh", "-o", "walk.glb"});
    CHECK(run.exit_code == 0);
    CHECK(run.out == "walk.glb: 11 joints, 1.60 m high, 51 keys, 1.00 s\n");
    const GltfScene scene = *load_gltf(folder.file("walk.glb"));
    CHECK(scene.skeleton.joints[1] == "Hips");
    CHECK(scene.clips[0].duration == 1.0f);
    run = run_limn(
        folder,
        {"import", "bvh", "walk.bvh", "-o", "walk.glb", "--set", "scale=0.02", "--set", "rate=10"});
    CHECK(run.out == "walk.glb: 11 joints, 3.20 m high, 11 keys, 1.00 s\n");
    run = run_limn(folder, {"import", "bvh", "walk.bvh", "-o", "walk.glb", "--set", "up=sideways"});
    check_fails(run, 1, "sideways");
    run = run_limn(folder, {"info", "walk.bvh"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("skeleton of 12 joints") != std::string::npos);
    write_text(folder.file("bad.bvh"), "ROOT a {");
    run = run_limn(folder, {"import", "bvh", "bad.bvh", "-o", "bad.glb"});
    check_fails(run, 1, "bad.bvh:1: unexpected end of the file, unclosed block");
    CHECK(!std::filesystem::exists(folder.file("bad.glb")));
}

TEST_CASE(
    "bake: motion writes what was recorded as .glb and as .bvh"
    * technique("char.mocap-cleanup, char.bvh-format")) {
    const TemporaryFolder folder;
    write_text(folder.file("walk.bvh"), make_bvh());
    ProgramRun run = run_limn(
        folder,
        {"bake", "motion", "walk.bvh", "-o", "clean.bvh", "--set", "cutoff=8", "--set", "rate=25"});
    CHECK(run.exit_code == 0);
    CHECK(run.out == "clean.bvh: 26 keys, 1.00 s, 0 contacts\n");
    const BvhFile bvh = *load_bvh(folder.file("clean.bvh"));
    CHECK(bvh.frames == 26);
    CHECK(bvh.joints.size() == 11);
    CHECK(bvh.values[bvh.channels() * 25 + 2] == near(100).epsilon(1e-4));
    run = run_limn(
        folder, {"bake", "motion", "clean.bvh", "-o", "still.glb", "--set", "travel=true"});
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("travels 1.00 m") != std::string::npos);
    const GltfScene scene = *load_gltf(folder.file("still.glb"));
    CHECK(scene.clips[0].contacts.size() == 2);
    run = run_limn(folder, {"bake", "motion", "walk.bvh", "-o", "walk.png"});
    check_fails(run, 1, "walk.png: expected a file name ending in .glb or .bvh for motion");
    run = run_limn(
        folder,
        {"bake", "motion", "walk.bvh", "-o", "a.glb", "--set", "loop=true", "--set", "loop_min=3"});
    check_fails(run, 1, "expected more than the shortest loop, 3 s");
}

TEST_CASE(
    "bake: markers of a body give the motion of its joints" * technique("char.marker-to-joint")) {
    const TemporaryFolder folder;
    write_text(folder.file("body.bvh"), make_bvh());
    write_text(
        folder.file("take.trc"),
        "PathFileType\t4\t(X/Y/"
        "Z)\ttake.trc\nDataRate\tUnits\n50\tm\nFrame#\tTime\ta\t\t\tb\t\t\tc\t\t\n"
        "\t\tX1\tY1\tZ1\n"
        "1\t0\t0\t1\t0\t0.1\t1\t0\t0\t1.1\t0\n"
        "2\t0\t0\t1\t1\t0.1\t1\t1\t0\t1.1\t1\n");
    write_text(
        folder.file("markers.json"),
        R"({"swap_margin": 0, "markers": [{"marker": "a", "joint": "Hips", "at": [0, 1, 0]},
            {"marker": "b", "joint": "Hips", "at": [0.1, 1, 0]}, {"marker": "c", "joint": "Hips", "at": [0, 1.1, 0]}]})");
    ProgramRun run = run_limn(
        folder,
        {"bake", "motion", "take.trc", "body.bvh", "--recipe", "markers.json", "-o", "take.bvh"});
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.find("residual 0.0 mm") != std::string::npos);
    const BvhFile bvh = *load_bvh(folder.file("take.bvh"));
    CHECK(bvh.values[bvh.channels() + 2] == near(100).epsilon(1e-4));
    run = run_limn(folder, {"bake", "motion", "take.trc", "-o", "take.bvh"});
    check_fails(run, 1, "take.trc: found no body, expected BODY");
    write_text(folder.file("markers.json"), R"({"markers": [{"marker": "d", "joint": "Hips"}]})");
    run = run_limn(
        folder,
        {"bake", "motion", "take.trc", "body.bvh", "--recipe", "markers.json", "-o", "take.bvh"});
    check_fails(run, 1, "markers.json: found the marker \"d\"");
}

TEST_CASE("bake: ghosts and curves show a motion standing still" * technique("char.ghost-view")) {
    const TemporaryFolder folder;
    write_text(folder.file("walk.bvh"), make_bvh());
    ProgramRun run = run_limn(
        folder, {"bake", "ghosts", "walk.bvh", "-o", "ghosts.glb", "--set", "step=0.25", "--set",
                 "trails=[\"LeftFoot\"]", "--set", "highlight=LeftLeg"});
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out == "ghosts.glb: 5 ghosts\n");
    CHECK(load_gltf(folder.file("ghosts.glb"))->skeleton.joints.empty());
    run = run_limn(
        folder, {"bake", "curves", "walk.bvh", "-o", "knee.svg", "--set", "joint=LeftLeg"});
    CHECK(run.exit_code == 0);
    CHECK(run.out == "knee.svg: 3 curves of 51 samples\n");
    CHECK(test::read_text(folder.file("knee.svg")).ends_with("</svg>\n"));
    run = run_limn(
        folder, {"bake", "curves", "walk.bvh", "-o", "knee.png", "--set", "joint=LeftLeg"});
    check_fails(run, 1, "knee.png: expected a file name ending in .svg for curves");
    run = run_limn(folder, {"bake", "curves", "walk.bvh", "-o", "a.svg", "--set", "joint=LeftLog"});
    check_fails(run, 1, "walk.bvh: found no joint \"LeftLog\" (did you mean LeftLeg?)");
}

TEST_CASE("bake: retarget gives a motion to another body" * technique("char.retarget-body")) {
    const TemporaryFolder folder;
    write_text(folder.file("walk.bvh"), make_bvh());
    ProgramRun run =
        run_limn(folder, {"import", "bvh", "walk.bvh", "-o", "body.glb", "--set", "scale=0.02"});
    run = run_limn(folder, {"bake", "retarget", "walk.bvh", "body.glb", "-o", "walking.glb"});
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.starts_with("walking.glb: 11 of 11 joints follow, legs 2.00 times as long"));
    const GltfScene scene = *load_gltf(folder.file("walking.glb"));
    REQUIRE(scene.clips.size() == 1);
    CHECK(scene.clips[0].name == "walk");
    CHECK(scene.clips[0].duration == 1.0f);
    write_text(
        folder.file("rock.bvh"),
        "ROOT rock { OFFSET 0 1 0 CHANNELS 1 Yposition } MOTION\nFrames: 1\nFrame Time: 1\n0\n");
    run = run_limn(folder, {"bake", "retarget", "walk.bvh", "rock.bvh", "-o", "rock.glb"});
    check_fails(run, 1, "walk.bvh, rock.bvh: found no joints that correspond");
    run = run_limn(folder, {"bake", "retarget", "walk.bvh", "-o", "rock.glb"});
    check_fails(run, 1, "walk.bvh: found no body, expected BODY after the motion");
    run = run_limn(folder, {"bake", "normal", "a.png", "b.png", "-o", "c.png"});
    check_fails(run, 1, "b.png: found a second file, expected one for normal");
}

}  // namespace limn::bake_motion_test
