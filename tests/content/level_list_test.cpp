#include "content/load/level/level_list.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::level_list_test {

TEST_CASE("levels: a name that is none names the nearest") {
    const Result<std::string> path = find_level("galery");
    REQUIRE_FALSE(path.ok());
    CHECK(path.error().message.find("(did you mean gallery?)") != std::string::npos);
}

}  // namespace limn::level_list_test
