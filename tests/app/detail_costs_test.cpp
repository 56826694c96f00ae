#include "content/app/player/detail_costs.h"

#include <doctest/doctest.h>

namespace limn::test::detail_costs_test {

TEST_CASE("detail costs: they are those of a step that has settled, per pixel and beside flat") {
    DetailCosts costs;
    const auto spend = [&](DetailLimit limit, double ms, float seconds) {
        for (float t = 0; t < seconds; t += 0.1f) {
            costs.add(limit, ms, {1000, 1000}, 0.1f);
        }
    };
    spend(DetailLimit::Full, 30, 3);
    CHECK(costs.describe().empty());  // nobody has changed it
    spend(DetailLimit::Flat, 30, 0.5f);
    CHECK(costs.describe() == "surface detail: flat");
    spend(DetailLimit::Flat, 10, 3);
    CHECK(costs.describe() == "surface detail: flat, 10 ns per pixel");
    spend(DetailLimit::Relief, 17, 3);
    CHECK(costs.describe() == "surface detail: relief at most, 17 ns per pixel, 1.70 times flat");
    spend(DetailLimit::Full, 99, 0.5f);  // not yet settled: its cost from before
    CHECK(
        costs.describe()
        == "surface detail: as the materials say, 30 ns per pixel, 3.00 times flat");
    costs.forget();
    CHECK(costs.describe().empty());
}

}  // namespace limn::test::detail_costs_test
