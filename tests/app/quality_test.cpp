#include "content/app/quality.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace limn {

using test::ProgramRun;
using test::read_text;
using test::run_limn;
using test::TemporaryFolder;

namespace {

QualityReport small_report() {
    const ColorImage gray = {.width = 2, .height = 1, .pixels = {Vec3(0.25f), Vec3(0.5f)}};
    const ColorImage lighter = {.width = 2, .height = 1, .pixels = {Vec3(0.25f), Vec3(1.0f)}};
    return {
        .rows =
            {{"error", 0.5, QualityBound::AtMost, 1, "px"},
             {"psnr <of> it", 30, QualityBound::AtLeast, 32, "dB"},
             {"told", 7}},
        .pictures = {{"plate & lamp", gray, lighter}, {"alone", gray}}};
}

MeasuredQuality measured() {
    static const QualityEffect effect = {"sample", "what is exact", nullptr};
    return {&effect, small_report()};
}

std::size_t count_of(const std::string& text, std::string_view word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++count;
    }
    return count;
}

}  // namespace

TEST_CASE("quality: a bound holds up to its limit, and never for what is no number") {
    CHECK(holds({"", 1, QualityBound::AtMost, 1}));
    CHECK_FALSE(holds({"", 1.001, QualityBound::AtMost, 1}));
    CHECK(holds({"", 1, QualityBound::AtLeast, 1}));
    CHECK_FALSE(holds({"", 0.999, QualityBound::AtLeast, 1}));
    CHECK_FALSE(holds({"", std::nan(""), QualityBound::AtMost, 1}));
    CHECK_FALSE(holds({"", std::nan(""), QualityBound::AtLeast, 1}));
    CHECK(holds({"", std::nan(""), QualityBound::None, 0}));
}

TEST_CASE("quality: table, JSON and page say of every row whether it holds") {
    const MeasuredQuality one = measured();
    const std::string table = quality_table({&one, 1});
    CHECK(count_of(table, "\n") == 4);
    CHECK(count_of(table, "DOES NOT HOLD") == 1);
    CHECK(table.find("0.5 px") != std::string::npos);

    const auto json = nlohmann::json::parse(quality_json({&one, 1}, "some GPU"));
    CHECK(json["gl"] == "some GPU");
    CHECK(json["effects"][0]["name"] == "sample");
    const auto& rows = json["effects"][0]["rows"];
    REQUIRE(rows.size() == 3);
    CHECK(rows[0]["holds"] == true);
    CHECK(rows[1]["holds"] == false);
    CHECK(rows[1]["bound"] == "at_least");
    CHECK(rows[2]["bound"] == "none");
}

TEST_CASE("quality: the page has effect, oracle and difference of each picture within itself") {
    const MeasuredQuality one = measured();
    const Result<std::string> page = quality_html({&one, 1}, "GPU <x>");
    REQUIRE(page);
    CHECK(count_of(*page, "<img ") == 3 + 1);
    // Every picture is a whole PNG: signature and end in base64.
    CHECK(count_of(*page, "src=\"data:image/png;base64,iVBORw0KGgo") == 4);
    CHECK(count_of(*page, "\" alt=\"") == 4);
    CHECK(page->find("GPU &lt;x&gt;") != std::string::npos);
    CHECK(page->find("psnr &lt;of&gt; it") != std::string::npos);
    CHECK(page->find("plate &amp; lamp") != std::string::npos);
    CHECK(page->find("<x>") == std::string::npos);
}

TEST_CASE("quality: lights keep their bounds by every method, and no list misses one") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "lights", "--json", "q.json"});
    CHECK(run.exit_code == 0);
    const nlohmann::json json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const nlohmann::json& rows = json["effects"][0]["rows"];
    REQUIRE(rows.size() == 7);
    for (const nlohmann::json& row : rows) {
        CHECK(row["holds"] == true);
    }
    CHECK(rows[0]["found"] <= 1.0);
}

TEST_CASE("quality: the surfaces keep their bounds, and an effect that is none is named") {
    const TemporaryFolder folder;
    const ProgramRun run =
        run_limn(folder, {"quality", "surfaces", "--json", "q.json", "--html", "q.html"});
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.starts_with("surfaces: "));
    CHECK(run.out.find("DOES NOT HOLD") == std::string::npos);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    CHECK(json["effects"].size() == 1);
    CHECK(json["effects"][0]["rows"].size() == 6);
    CHECK(read_text(folder.file("q.html")).ends_with("</html>\n"));

    const ProgramRun wrong = run_limn(folder, {"quality", "surfacs"});
    CHECK(wrong.exit_code == 1);
    CHECK(wrong.err.find("perhaps surfaces") != std::string::npos);
}

TEST_CASE("quality: every shadow method agrees with rays, and penumbras keep their law") {
    const TemporaryFolder folder;
    const ProgramRun run =
        run_limn(folder, {"quality", "shadows", "--json", "q.json", "--html", "q.html"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 9 + 8 + 9 + 3);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        CHECK(row["bound"] != "none");
    }
    // Of each method, of all in one corner, and of each penumbra: effect, oracle and difference.
    CHECK(count_of(read_text(folder.file("q.html")), "<img ") == 3 * (10 + 9 + 10 + 3));
}

TEST_CASE("quality: statistics and tone operators of the GPU are those of the oracle") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "tone", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 14);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        if (row["bound"] == "none") {  // the picture is worth it: five decades of light
            CHECK(row["found"] > 1e5);
        }
    }
}

TEST_CASE("quality: motion blur comes close to the mean of the moments of an exposure") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "motion-blur", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 18);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
    }
    // A row of the effect and one of the picture without it, for each scene.
    for (std::size_t i = 0; i + 1 < 16; i += 2) {
        CAPTURE(rows[i].dump());
        CHECK(rows[i]["found"].get<double>() > rows[i + 1]["found"].get<double>() + 3);
    }
}

TEST_CASE("quality: depth of field obeys the law of discs and does not leak") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "dof", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 12 + 5 + 2 + 2 * 3);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
    }
}

TEST_CASE("quality: glow keeps the light, is round, steady and the oracle's convolution") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "glow", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 5 + 2 * 3 + 4 + 3 * 2);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        if (row["bound"] == "none") {  // the scene is worth it: glow or glare changes it
            CHECK(row["found"] < 38);
        }
    }
}

TEST_CASE("quality: skinning is that of double precision, for many joints and morph targets") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "skinning", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 2 * 2 + 9);
    int told = 0;
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        told += row["bound"] == "none" ? 1 : 0;
    }
    CHECK(told == 1);  // what linear blending loses, which is why the others are there
}

TEST_CASE("quality: caustics are those of ten million photons") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "caustics", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 2 + 3 + 1 + 2 + 1);
    int told = 0;
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        told += row["bound"] == "none" ? 1 : 0;
    }
    CHECK(told == 1);  // the coarsest grid, which the others are nearer than
}

TEST_CASE("quality: open water is the sum of its waves, as high and as fast as the laws say") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "water", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 3 * 2 + 2 + 2 + 1 + 3);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        CHECK(row["bound"] != "none");
    }
}

TEST_CASE("quality: velocity is that of rays, and none where nothing has moved") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "velocity", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 5 * 2 + 5);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
        if (row["bound"] == "none") {  // the scene is worth it: it moves
            CHECK(row["found"] > 10);
        }
    }
}

TEST_CASE("quality: ripples shift as geometry says and leave alone what stands before them") {
    const TemporaryFolder folder;
    const ProgramRun run = run_limn(folder, {"quality", "ripple", "--json", "q.json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    const auto& rows = json["effects"][0]["rows"];
    CHECK(rows.size() == 6 * 4 + 1);
    for (const auto& row : rows) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
    }
}

}  // namespace limn
