#include "content/load/faces/action_unit_names.h"

#include <doctest/doctest.h>

namespace limn::action_unit_names_test {
namespace {

TEST_CASE("action unit names: those of ARKit, ICT FaceKit, MakeHuman and FACS are the same units") {
    for (const char* const smile :
         {"mouthSmileLeft", "mouthSmile_L", "AU12_L", "au12left", "AU12_left",
          "blendShape1.mouthSmileLeft"}) {
        CAPTURE(smile);
        CHECK(find_action_unit(smile) == "AU12_L");
    }
    CHECK(find_action_unit("noseSneerRight") == "AU9_R");
    CHECK(find_action_unit("nose-right-elevation") == "AU9_R");
    CHECK(find_action_unit("browInnerUp") == "AU1");
    CHECK(find_action_unit("AU18") == "AU18");
    CHECK(find_action_unit("mouthPucker") == "AU18");
    CHECK(find_action_unit("cheekSquintRight") == "AU6_R");
    CHECK(find_action_unit("eyeLookInLeft") == "AU62_L");
}

TEST_CASE("action unit names: a side that is a direction is not half of a shape") {
    CHECK(find_action_unit("jawLeft") == "AU30_L");
    CHECK(find_action_unit("mouthLeft").empty());
}

TEST_CASE("action unit names: other names have no unit") {
    for (const char* const name :
         {"", ".", "Left", "_L", "AU", "AU_L", "AUx", "AU123", "smile", "fat", "viseme_aa"}) {
        CAPTURE(name);
        CHECK(find_action_unit(name).empty());
    }
}

}  // namespace
}  // namespace limn::action_unit_names_test
