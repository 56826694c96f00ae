#include "ecs/base/log.h"
#include "ecs/base/rng.h"
#include "ecs/base/text.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace limn;

TEST_CASE("text: each {} is replaced by the next argument") {
    const std::string name = "point_light";
    CHECK(format_text("no places") == "no places");
    CHECK(
        format_text("{}: found {}, expected {}{}", name, -3, std::string_view("4"), '!')
        == "point_light: found -3, expected 4!");
    CHECK(format_text("{} {} {}", true, false, std::uint8_t{200}) == "true false 200");
    CHECK(
        format_text("{} {}", std::numeric_limits<std::int64_t>::min(), ~std::uint64_t{0})
        == "-9223372036854775808 18446744073709551615");
    CHECK(format_text("{{}}", 1) == "{1}");
    CHECK(format_text("a {} in braces", "{}") == "a {} in braces");
    CHECK(fail("{} is gone", "entity 3 v1").message == "entity 3 v1 is gone");
}

TEST_CASE("text: numbers have the fewest digits that distinguish them, as fmt writes them") {
    for (const double number :
         {0.0, -0.0, 0.1, 1.0, -1.5, 1e15, 123456789012345.0, 1e16, 1e-4, 1.25e-5, 3e300, 5e-324}) {
        CHECK(format_text("{}", number) == fmt::format("{}", number));
        const auto as_float = static_cast<float>(number);
        CHECK(format_text("{}", as_float) == fmt::format("{}", as_float));
    }
    CHECK(format_text("{} {}", INFINITY, -INFINITY) == "inf -inf");
    CHECK(format_text("{}", std::numeric_limits<double>::quiet_NaN()) == "nan");

    Random random(1, 2, name_hash("text_test"), 3);
    for (int i = 0; i < 20000; ++i) {
        const auto number = std::bit_cast<float>(random.word());
        const double wide = std::bit_cast<double>(
            (std::uint64_t{random.word()} << 32) | std::uint64_t{random.word()});
        REQUIRE(format_text("{} {}", number, wide) == fmt::format("{} {}", number, wide));
    }
}

TEST_CASE("text: tables are aligned and joined") {
    CHECK(align_right(42, 5) == "   42");
    CHECK(align_left("spin", 6) + "|" == "spin  |");
    CHECK(align_right("longer", 3) == "longer");
    CHECK(align_right(fixed_text(1.0 / 3.0, 3), 9) == fmt::format("{:9.3f}", 1.0 / 3.0));
    CHECK(fixed_text(1e300, 1) == fmt::format("{:.1f}", 1e300));
    CHECK(join_text(std::vector<std::string>{"a", "b", "c"}, ", ") == "a, b, c");
    CHECK(join_text(std::vector<int>{}, ", ").empty());
}

namespace {

std::vector<std::string> caught;

void catch_message(LogLevel level, std::string_view message) {
    caught.push_back(format_text("{} {}", static_cast<int>(level), message));
}

}  // namespace

TEST_CASE("log: a sink gets what is not below the level, errors are counted") {
    const std::uint64_t errors = logged_error_count();
    set_log_sink(catch_message);
    log_debug("not seen");
    log_warn("{} bytes left", 3);
    set_log_level(LogLevel::Error);
    log_warn("not seen either");
    log_error("gone");
    set_log_level(LogLevel::Info);
    set_log_sink(nullptr);
    CHECK(caught == std::vector<std::string>{"2 3 bytes left", "3 gone"});
    CHECK(logged_error_count() == errors + 1);
}
