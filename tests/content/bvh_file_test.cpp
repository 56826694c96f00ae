#include "content/load/motion/bvh_file.h"
#include "ecs/base/rng.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::bvh_file_test {
namespace {

const std::string kMotion = "MOTION\n"                         // line 13
                            "Frames: 2\n"                      // 14
                            "Frame Time: 0.033333\n"           // 15
                            "1 2 3 10 20 30 40 50 60\n"        // 16
                            "-1 .5 +3 1e1 -20 0 0 0 1e-50\n";  // 17
const std::string kTree =
    "HIERARCHY\n"       // 1
    "ROOT Hips\n"       // 2
    "{\n"               // 3
    "\tOFFSET 0 1 0\n"  // 4
    "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "\tJOINT Left Knee\n"             // 6
    "\t{\n"                           // 7
    "\t\tOFFSET 0 -18.469999 0.25\n"  // 8
    "\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n"
    "\t\tEnd Site { OFFSET 0 -3 1 }\n"  // 10
    "\t}\n"                             // 11
    "}\n";                              // 12

std::string error_of(const std::string& text, const BvhLimits& limits = {}) {
    const Result<BvhFile> bvh = parse_bvh(text, "a.bvh", limits);
    return bvh ? "none" : bvh.error().message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    REQUIRE(text.find(from) != std::string::npos);
    return text.replace(text.find(from), from.size(), to);
}

BvhFile read(const std::string& text) {
    const Result<BvhFile> bvh = parse_bvh(text, "a.bvh");
    REQUIRE_MESSAGE(bvh.ok(), (bvh ? "" : bvh.error().message));
    return *bvh;
}

void check_equal(const BvhFile& a, const BvhFile& b) {
    REQUIRE(a.joints.size() == b.joints.size());
    for (std::size_t j = 0; j < a.joints.size(); ++j) {
        CHECK(a.joints[j].name == b.joints[j].name);
        CHECK(a.joints[j].parent == b.joints[j].parent);
        CHECK(a.joints[j].offset == b.joints[j].offset);
        CHECK(a.joints[j].is_end == b.joints[j].is_end);
        CHECK(a.joints[j].channels == b.joints[j].channels);
        CHECK((a.joints[j].first_value == b.joints[j].first_value || a.joints[j].is_end));
    }
    CHECK(a.frame_time == b.frame_time);
    CHECK(a.frames == b.frames);
    CHECK(a.values == b.values);
}

/// A file with random joints, channels and numbers.
BvhFile random_file(std::uint64_t seed) {
    Random random(seed, 1, 2, 3);
    BvhFile bvh;
    std::size_t values = 0;
    std::vector<std::size_t> open;
    const int count = 2 + static_cast<int>(30 * random.uniform());
    for (int j = 0; j < count; ++j) {
        while (open.size() > 1 && (bvh.joints[open.back()].is_end || random.uniform() < 0.3f)) {
            open.pop_back();  // so that joints are depth first
        }
        BvhJoint joint;
        joint.parent = open.empty() ? -1 : static_cast<std::int32_t>(open.back());
        joint.is_end = j > 0 && random.uniform() < 0.2f;
        joint.name = joint.is_end ? "" : "joint " + std::to_string(j);
        joint.offset = 100.0f * random.direction();
        joint.first_value = values;
        for (int c = 0; c < kBvhChannels && !joint.is_end; ++c) {
            if (random.uniform() < 0.6f) {
                joint.channels.push_back(static_cast<BvhChannel>(5 - c));
            }
        }
        values += joint.channels.size();
        open.push_back(static_cast<std::size_t>(j));
        bvh.joints.push_back(joint);
    }
    bvh.frames = static_cast<std::size_t>(20 * random.uniform());
    bvh.frame_time = 0.001f + random.uniform();
    for (std::size_t i = 0; i < bvh.frames * values; ++i) {
        bvh.values.push_back(1000 * (random.uniform() - 0.5f));
    }
    return bvh;
}

}  // namespace

TEST_CASE(
    "BVH file: joints, channels and rows are read as they stand" * technique("char.bvh-format")) {
    const BvhFile bvh = read(kTree + kMotion);
    REQUIRE(bvh.joints.size() == 3);
    CHECK(bvh.joints[0].name == "Hips");
    CHECK(bvh.joints[1].name == "Left Knee");
    CHECK(bvh.joints[1].parent == 0);
    CHECK(bvh.joints[1].offset == Vec3(0, -18.469999f, 0.25f));
    CHECK(bvh.joints[1].first_value == 6);
    CHECK(bvh.joints[2].is_end);
    CHECK(bvh.joints[2].name.empty());
    CHECK(bvh.joints[2].parent == 1);
    using enum BvhChannel;
    CHECK(
        bvh.joints[0].channels
        == std::vector{Xposition, Yposition, Zposition, Zrotation, Xrotation, Yrotation});
    CHECK(bvh.channels() == 9);
    CHECK(bvh.frames == 2);
    CHECK(bvh.frame_time == 0.033333f);
    CHECK(bvh.values[8] == 60);
    CHECK(bvh.values[10] == 0.5f);
    CHECK(bvh.values[11] == 3);
    CHECK(bvh.values[17] == 0);
}

TEST_CASE(
    "BVH file: tabs, CR LF, CR, a byte order mark, no HIERARCHY and other cases change nothing"
    * technique("char.bvh-format")) {
    const std::string text = kTree + kMotion;
    const BvhFile expected = read(text);
    std::string crlf = "\xef\xbb\xbf";
    std::string cr;
    std::string tabs;
    for (const char c : text) {
        crlf += c == '\n' ? "\r\n" : std::string(1, c);
        cr += c == '\n' ? '\r' : c;
        tabs += c == ' ' ? "\t " : c == '\n' ? "  \n\n\t" : std::string(1, c);
    }
    check_equal(read(crlf), expected);
    check_equal(read(cr), expected);
    check_equal(read(replaced(tabs, "Left\t Knee", "Left Knee")), expected);
    check_equal(read(text.substr(text.find("ROOT"))), expected);
    check_equal(read(replaced(text, "HIERARCHY", "hierarchy")), expected);
    check_equal(read(replaced(text, "Zrotation", "ZROTATION")), expected);
    check_equal(read(replaced(text, "Frames: 2", "Frames:2")), expected);
    check_equal(read(replaced(text, "Frame Time: ", "Frame Time :\t")), expected);
    check_equal(read(replaced(text, "End Site {", "END SITE Tip{")), expected);
    CHECK(error_of(replaced(cr, "1e1", "x")).starts_with("a.bvh:17: found \"x\""));
    CHECK(error_of(replaced(crlf, "1e1", "x")).starts_with("a.bvh:17: found \"x\""));
}

TEST_CASE(
    "BVH file: what is written is read again, number for number" * technique("char.bvh-format")) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const BvhFile bvh = random_file(seed);
        check_equal(read(write_bvh(bvh)), bvh);
        CHECK(write_bvh(read(write_bvh(bvh))) == write_bvh(bvh));
    }
    for (const char* const name : {"walk1.bvh", "dance1.bvh", "face-poseunits.bvh"}) {
        const auto path = test::shared_asset(std::string("makehuman/bvh/") + name);
        if (path) {
            const BvhFile bvh = *load_bvh(*path);
            CHECK(bvh.warnings.empty());
            check_equal(read(write_bvh(bvh)), bvh);
        }
    }
}

TEST_CASE(
    "BVH file: errors have the line, what was found and what was expected"
    * technique("char.bvh-format")) {
    const std::string text = kTree + kMotion;
    const auto error_with = [&](const std::string& from, const std::string& to) {
        return error_of(replaced(text, from, to));
    };
    // The sample of the book does not close its root.
    const std::string open = kTree.substr(0, kTree.rfind('}'));
    CHECK(
        error_of(open)
        == "a.bvh:11: unexpected end of the file, unclosed block: expected } for the block of "
           "\"Hips\" that begins in line 3");
    CHECK(error_of(open + kMotion).starts_with("a.bvh:12: found \"MOTION\", expected OFFSET"));
    CHECK(error_of(kTree) == "a.bvh:12: found the end of the file, expected MOTION");
    CHECK(error_of("") == "a.bvh:1: found the end of the file, expected ROOT");
    CHECK(error_of(text.substr(text.find("{"))) == "a.bvh:1: found \"{\", expected ROOT");
    CHECK(
        error_with("MOTION", "ROOT a {} MOTION")
        == "a.bvh:13: found a second ROOT, expected MOTION");
    CHECK(
        error_with("1e1 -20 0 0 0", "1e1 -20 0 0")
        == "a.bvh:17: found 8 numbers in the row of frame 1, expected 9, one per channel");
    CHECK(
        error_with("40 50 60", "40 50 60 70")
        == "a.bvh:16: found 10 numbers in the row of frame 0, expected 9, one per channel");
    CHECK(
        error_with("Frames: 2", "Frames: 3") == "a.bvh:17: found 2 rows, expected 3 as in line 14");
    CHECK(error_with("Frames: 2", "Frames: -2").starts_with("a.bvh:14: Frames: found \"-2\""));
    CHECK(error_with("Frames: 2", "Frames: 99999999999").starts_with("a.bvh:14: Frames: found"));
    for (const char* const time : {"0", "-0.1", "1e8"}) {
        CHECK(error_with("0.033333", time).starts_with("a.bvh:15: found the frame time"));
    }
    for (const char* const number : {"nan", "inf", "-infinity", "1e400", "1,5", "0x10", "2e9"}) {
        CHECK(error_with("50", number).find("expected a number") != std::string::npos);
        CHECK(error_with("-18.469999", number).starts_with("a.bvh:8: OFFSET: found"));
        CHECK(error_with("0.033333", number).starts_with("a.bvh:15: "));
    }
    CHECK(error_with("Xrotation", "Wrotation")
              .starts_with("a.bvh:5: CHANNELS of \"Hips\": found \"Wrotation\""));
    CHECK(
        error_with("Xrotation", "Zrotation").find("found \"Zrotation\" again")
        != std::string::npos);
    CHECK(error_with("CHANNELS 3", "CHANNELS 4")
              .starts_with("a.bvh:10: CHANNELS of \"Left Knee\": found \"End\""));
    CHECK(error_with("CHANNELS 3", "CHANNELS 7").starts_with("a.bvh:9: CHANNELS: found \"7\""));
    CHECK(error_with("OFFSET 0 1 0", "").starts_with("a.bvh:12: found no OFFSET of \"Hips\""));
    CHECK(
        error_with("OFFSET 0 1 0", "OFFSET 0 1 0 OFFSET 0 1 0").find("a second OFFSET")
        != std::string::npos);
    CHECK(
        error_with("JOINT Left Knee", "JOINT").find("expected the name of a joint")
        != std::string::npos);
    CHECK(
        error_with("OFFSET 0 -3 1", "CHANNELS 3").find("expected OFFSET or }")
        != std::string::npos);
    CHECK(error_of("\xff\xfeR") == "a.bvh: found a text in UTF-16, expected UTF-8 or ASCII");
    CHECK(error_of(text, {.max_joints = 2}).starts_with("a.bvh:10: found more than 2 joints"));
    CHECK(error_of(text, {.max_values = 10}).starts_with("a.bvh:17: found more than 10 numbers"));
}

TEST_CASE(
    "BVH file: rows beyond the stated frames are ignored with a warning"
    * technique("char.bvh-format")) {
    const BvhFile bvh = read(replaced(kTree + kMotion, "Frames: 2", "Frames: 1"));
    CHECK(bvh.frames == 1);
    CHECK(bvh.values.size() == 9);
    REQUIRE(bvh.warnings.size() == 1);
    CHECK(bvh.warnings[0].starts_with("a.bvh:17: found rows after 1 frames"));
}

TEST_CASE(
    "BVH file: a file without channels has frames without numbers" * technique("char.bvh-format")) {
    const std::string text = "ROOT Rock { OFFSET 1 2 3 } MOTION\nFrames: 5\nFrame Time: 0.1\n\n\n";
    const BvhFile bvh = read(text);
    CHECK(bvh.channels() == 0);
    CHECK(bvh.frames == 5);
    CHECK(bvh.values.empty());
    check_equal(read(write_bvh(bvh)), bvh);
    CHECK(error_of(text + "7\n").starts_with("a.bvh:6: found 1 numbers"));
}

TEST_CASE(
    "BVH file: 10,000 frames of 300 joints, and a chain of 60,000"
    * technique("char.bvh-format, char.skeleton-hierarchy")) {
    BvhFile big;
    for (int j = 0; j < 300; ++j) {
        BvhJoint joint{"j" + std::to_string(j), j - 1, {0, 1, 0}, false, 0, {}};
        joint.first_value = static_cast<std::size_t>(j);
        joint.channels = {BvhChannel::Xrotation};
        big.joints.push_back(joint);
    }
    big.frames = 10'000;
    big.values.assign(300 * big.frames, 0.0f);
    for (std::size_t i = 0; i < big.values.size(); ++i) {
        big.values[i] = static_cast<float>(i % 360);
    }
    const BvhFile again = read(write_bvh(big));
    CHECK(again.values == big.values);

    BvhFile chain;
    for (int j = 0; j < 60'000; ++j) {
        chain.joints.push_back({"j", j - 1, {0, 1, 0}, false, 0, {}});
    }
    check_equal(read(write_bvh(chain)), chain);
}

}  // namespace limn::bvh_file_test
