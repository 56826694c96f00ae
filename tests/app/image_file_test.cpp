#include "content/app/commands/image_file.h"

#include <doctest/doctest.h>

namespace limn::image_file_test {

TEST_CASE("image_file: the extension decides the format") {
    CHECK(*image_file_kind("a.png") == ImageFileKind::Png);
    CHECK(*image_file_kind("folder/A.EXR") == ImageFileKind::Exr);
    for (const char* bad : {"", "a", "a.jpg", ".png", "png", "a.png.txt"}) {
        CAPTURE(bad);
        CHECK_FALSE(image_file_kind(bad));
    }
}

TEST_CASE("image_file: %04d becomes the frame number, and any other % is refused") {
    CHECK(*has_frame_number("frame_%04d.png"));
    CHECK(*has_frame_number("%d.png"));
    CHECK_FALSE(*has_frame_number("frame.png"));
    for (const char* bad :
         {"%s.png", "%04d_%04d.png", "%n.png", "%04", "%4d.png", "%0d.png", "100%.png"}) {
        CAPTURE(bad);
        CHECK_FALSE(has_frame_number(bad));
    }
    CHECK(numbered_path("frame_%04d.png", 7) == "frame_0007.png");
    CHECK(numbered_path("f%02d.exr", 123) == "f123.exr");
    CHECK(numbered_path("%d.png", 5) == "5.png");
    CHECK(numbered_path("still.png", 5) == "still.png");
}

}  // namespace limn::image_file_test
