#include "content/app/bench/frame_statistics.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::frame_statistics_test {

TEST_CASE("frame_statistics: median, p95 and max of 1 .. 100 in any order") {
    std::vector<double> samples;
    for (int i = 0; i < 100; ++i) {
        samples.push_back((i * 37) % 100 + 1);
    }
    const Summary summary = summarize(samples);
    CHECK(summary.median == 50.5);
    CHECK(summary.p95 == 95.0);
    CHECK(summary.max == 100.0);
}

TEST_CASE("frame_statistics: one sample is its own summary, none is zero") {
    const double one = 7.0;
    const Summary single = summarize({&one, 1});
    CHECK(single.median == 7.0);
    CHECK(single.p95 == 7.0);
    CHECK(single.max == 7.0);
    CHECK(summarize({}).max == 0.0);
}

TEST_CASE("frame_statistics: a history forgets the oldest sample first") {
    FrameHistory history(3);
    for (const double sample : {9.0, 1.0, 2.0, 3.0}) {
        history.add(sample);
    }
    CHECK(history.size() == 3);
    CHECK(history.sample(0) == 1.0);
    CHECK(history.sample(2) == 3.0);
    CHECK(history.summary().max == 3.0);
    CHECK(history.sample(0) == 1.0);  // asking for the summary does not reorder it
}

}  // namespace limn::frame_statistics_test
