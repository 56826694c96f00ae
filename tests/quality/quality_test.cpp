#include "bench/quality/quality.h"
#include "tests/app/run_program.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace limn::quality_test {

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
        .images = {{"plate & lamp", gray, lighter}, {"alone", gray}}};
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

/// The rows of `limn quality EFFECT`, which must hold.
nlohmann::json measured_rows(
    const std::string& effect, const TemporaryFolder& folder = {},
    const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments = {"quality", effect,   "--json",
                                          "q.json",  "--html", "q.html"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramRun run = run_limn(folder, arguments);
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.out.starts_with(effect + ": "));
    const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
    REQUIRE(json["effects"].size() == 1);
    for (const nlohmann::json& row : json["effects"][0]["rows"]) {
        CAPTURE(row.dump());
        CHECK(row["holds"] == true);
    }
    return json["effects"][0]["rows"];
}

std::size_t count_unbounded(const nlohmann::json& rows) {
    return static_cast<std::size_t>(std::count_if(
        rows.begin(), rows.end(), [](const auto& row) { return row["bound"] == "none"; }));
}

}  // namespace

TEST_CASE("quality: a bound holds up to its limit, and never for NaN") {
    CHECK(holds({"", 1, QualityBound::AtMost, 1}));
    CHECK_FALSE(holds({"", 1.001, QualityBound::AtMost, 1}));
    CHECK(holds({"", 1, QualityBound::AtLeast, 1}));
    CHECK_FALSE(holds({"", 0.999, QualityBound::AtLeast, 1}));
    CHECK_FALSE(holds({"", std::nan(""), QualityBound::AtMost, 1}));
    CHECK_FALSE(holds({"", std::nan(""), QualityBound::AtLeast, 1}));
    CHECK(holds({"", std::nan(""), QualityBound::None, 0}));
}

TEST_CASE("quality: table, JSON and page show for every row whether it holds") {
    const MeasuredQuality one = measured();
    const std::string table = quality_table({&one, 1});
    CHECK(count_of(table, "\n") == 4);
    CHECK(count_of(table, "VIOLATED") == 1);
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

TEST_CASE("quality: the page embeds effect, oracle and difference of each image") {
    const MeasuredQuality one = measured();
    const Result<std::string> page = quality_html({&one, 1}, "GPU <x>");
    REQUIRE(page);
    CHECK(count_of(*page, "<img ") == 3 + 1);
    // Every image is a whole PNG: signature and end in base64.
    CHECK(count_of(*page, "src=\"data:image/png;base64,iVBORw0KGgo") == 4);
    CHECK(count_of(*page, "\" alt=\"") == 4);
    CHECK(page->find("GPU &lt;x&gt;") != std::string::npos);
    CHECK(page->find("psnr &lt;of&gt; it") != std::string::npos);
    CHECK(page->find("plate &amp; lamp") != std::string::npos);
    CHECK(page->find("<x>") == std::string::npos);
}

TEST_CASE("quality: numbers beside other sections are collapsed, unless a bound is violated") {
    MeasuredQuality one = measured();
    one.report.html = "<h3>own</h3>\n";
    const std::string violated = quality_html({&one, 1}, "GPU").value();
    CHECK(count_of(violated, "<details open>") == 1);
    CHECK(count_of(violated, "<h3>own</h3>") == 1);
    one.report.rows.erase(one.report.rows.begin() + 1);
    CHECK(count_of(quality_html({&one, 1}, "GPU").value(), "<details>") == 1);
    one.report.html.clear();
    CHECK(count_of(quality_html({&one, 1}, "GPU").value(), "<details") == 0);
}

TEST_CASE("quality: without its program beside it, limn says what is missing and how to build it") {
    const TemporaryFolder folder;
    const std::string alone = folder.file("limn");
    std::filesystem::copy_file(LIMN_PROGRAM, alone);
    const ProgramRun run = test::Program(folder, {"quality", "surfaces"}, alone).wait();
    CHECK(run.exit_code == 1);
    CHECK(run.out.empty());
    CHECK(count_of(run.err, "\n") == 1);
    CHECK(run.err.find(alone + "-quality") != std::string::npos);
    CHECK(run.err.find("--target limn-quality") != std::string::npos);
}

TEST_CASE("quality: wrong usage ends with 2, and the effects are listed in the help") {
    const TemporaryFolder folder;
    const auto wrong = [&](const std::vector<std::string>& arguments) {
        const ProgramRun run = run_limn(folder, arguments);
        CHECK(run.exit_code == 2);
        CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
        return run.err;
    };
    CHECK(wrong({"quality", "--jsn", "q.json"}).find("--jsn") != std::string::npos);
    const std::string unknown = wrong({"quality", "surfacs"});
    CHECK(unknown.find("(did you mean surfaces?)") != std::string::npos);
    const std::string no_file = wrong({"quality", "shadows", "flat.obj"});
    CHECK(no_file.find("found the file flat.obj") != std::string::npos);
    const ProgramRun help = run_limn(folder, {"quality", "--help"});
    CHECK(help.exit_code == 0);
    CHECK(quality_effects().size() == 23);
    for (const QualityEffect& effect : quality_effects()) {
        CHECK(
            help.out.find(fmt::format("  {:<12}vs {}\n", effect.name, effect.oracle))
            != std::string::npos);
    }
}

TEST_CASE("quality: lights keep their bounds by every method, and no list misses one") {
    const nlohmann::json rows = measured_rows("lights");
    REQUIRE(rows.size() == 7);
    CHECK(rows[0]["found"] <= 1.0);
}

TEST_CASE(
    "quality: fakephong keeps the printed figures and orders, and describes each method on the page"
    * technique("fakephong.results")) {
    const TemporaryFolder folder;
    measured_rows("fakephong", folder);
    const std::string page = read_text(folder.file("q.html"));
    CHECK(count_of(page, "It holds best on") == 13);
    CHECK(count_of(page, "<svg") == 13 * 7);
    CHECK(count_of(page, "<polyline") == 2 * 13 * 7);
    CHECK(count_of(page, "<img") == 3 * 13 * 7);
    CHECK(count_of(page, "as printed</em></td>") == 2);
    CHECK(count_of(page, "<b>teapot, fitted</b>: correctness 0.9884;") == 1);  // the Blinn map
    CHECK(count_of(page, ">its distance from the print<") == 2);
    CHECK(count_of(page, "all six columns are in the printed order") == 2);
    CHECK(count_of(page, "15 of 15") == 3);  // sizes of textures
    CHECK(
        count_of(page, "0.0063 behind it on the teapot and 0.0853 behind it on the triangle") == 1);
    CHECK(count_of(page, "Forward differences: ") == 2);
    CHECK(count_of(page, "<details>") == 1);  // closed: all bounds hold
    CHECK(page.find(">nan") == std::string::npos);
}

TEST_CASE("quality: fakephong measures a given model, whatever its normals and facets are like") {
    const TemporaryFolder folder;
    const std::string corners = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\n";
    const auto found = [&](const std::string& obj, const std::string& row) {
        test::write_text(folder.file("a.obj"), obj);
        const ProgramRun run =
            run_limn(folder, {"quality", "fakephong", "a.obj", "--json", "q.json"});
        CAPTURE(obj);
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        const auto json = nlohmann::json::parse(read_text(folder.file("q.json")));
        for (const auto& one : json["effects"][0]["rows"]) {
            if (one["name"] == row) {
                return one["found"].get<double>();
            }
        }
        FAIL("no row " << row);
        return 0.0;
    };
    const std::string front = corners + "vn 0 0 1\nf 1//1 2//1 3//1\n";
    CHECK(found(front, "triangles") == 1);
    CHECK(found(front, "pixels covered") > 1000);
    CHECK(found(front, "Gouraud: color correctness") < 1);
    CHECK(found(corners + "vn 0 0 1\nf 3//1 2//1 1//1\n", "pixels covered") == 0);  // from behind
    CHECK(found(corners + "vn 0 0 0\nf 1//1 2//1 3//1\n", "pixels covered") > 1000);
    CHECK(
        found(corners + "vn 0 0 1\nvn 0 0 -1\nf 1//1 2//2 3//1\n", "quadratic: color correctness")
        > 0);
    CHECK(found(front, "Blinn coordinates along edges, from linear, mean") > 0);
    const ProgramRun odd = [&] {
        test::write_text(folder.file("<b>&.obj"), front);
        return run_limn(folder, {"quality", "fakephong", "<b>&.obj", "--html", "q.html"});
    }();
    CHECK(odd.exit_code == 0);
    CHECK(read_text(folder.file("q.html")).find("<b>&.obj") == std::string::npos);
    const std::string twice = front + "f 1//1 1//1 2//1\nf 2//1 3//1 3//1\n";
    CHECK(found(twice, "  without an area, left out") == 2);
}

TEST_CASE("quality: a model that cannot be shaded is rejected in one line that names it") {
    const TemporaryFolder folder;
    const auto refused = [&](const std::vector<std::string>& arguments) {
        std::vector<std::string> all = {"quality"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const ProgramRun run = run_limn(folder, all);
        CHECK(run.exit_code == 1);
        CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
        return run.err;
    };
    CHECK(refused({"fakephong", "none.glb"}).find("none.glb: no such file") != std::string::npos);
    test::write_text(folder.file("flat.obj"), "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n");
    CHECK(
        refused({"fakephong", "flat.obj"}).find("none with an area, expected at least one")
        != std::string::npos);
    test::write_text(folder.file("empty.obj"), "# nothing\n");
    CHECK(refused({"fakephong", "empty.obj"}).find("empty.obj") != std::string::npos);
}

TEST_CASE("quality: the surfaces keep their bounds") {
    const TemporaryFolder folder;
    CHECK(measured_rows("surfaces", folder).size() == 6);
    CHECK(read_text(folder.file("stdout.txt")).find("VIOLATED") == std::string::npos);
    CHECK(read_text(folder.file("q.html")).ends_with("</html>\n"));
}

TEST_CASE(
    "quality: texture functions and filters are those of their definitions"
    * technique("tex.sampling")) {
    const TemporaryFolder folder;
    // 24 functions, of which the 15 without a comparison are filtered, too; 10 filters, 3 floors.
    CHECK(measured_rows("sampling", folder).size() == 24 + 15 + 10 + 3);
    CHECK(read_text(folder.file("stdout.txt")).find("VIOLATED") == std::string::npos);
}

TEST_CASE("quality: light spreads in skin and shines through it as the profile says") {
    for (const char* profile : {"software", "gpu"}) {
        const TemporaryFolder folder;
        CHECK(measured_rows("skin", folder, {"--profile", profile}).size() == 24);
        CHECK(read_text(folder.file("stdout.txt")).find("VIOLATED") == std::string::npos);
    }
}

TEST_CASE("quality: every shadow method agrees with rays, and penumbras keep their law") {
    const TemporaryFolder folder;
    const nlohmann::json rows = measured_rows("shadows", folder);
    CHECK(rows.size() == 9 + 8 + 9 + 3);
    CHECK(count_unbounded(rows) == 0);
    // Of each method, of all in one corner, and of each penumbra: effect, oracle and difference.
    CHECK(count_of(read_text(folder.file("q.html")), "<img ") == 3 * (10 + 9 + 10 + 3));
}

TEST_CASE("quality: statistics and tone operators of the GPU are those of the oracle") {
    const nlohmann::json rows = measured_rows("tone");
    CHECK(rows.size() == 14);
    for (const auto& row : rows) {
        if (row["bound"] == "none") {  // the image covers five decades of light
            CHECK(row["found"] > 1e5);
        }
    }
}

TEST_CASE("quality: motion blur is close to the mean over the exposure") {
    const nlohmann::json rows = measured_rows("motion-blur");
    CHECK(rows.size() == 18);
    // For each scene, a row with the effect and one without it.
    for (std::size_t i = 0; i + 1 < 16; i += 2) {
        CAPTURE(rows[i].dump());
        CHECK(rows[i]["found"].get<double>() > rows[i + 1]["found"].get<double>() + 3);
    }
}

TEST_CASE("quality: depth of field obeys the law of discs and does not leak") {
    CHECK(measured_rows("dof").size() == 12 + 5 + 2 + 2 * 3);
}

TEST_CASE(
    "quality: glow conserves energy, is round and stable, and matches the oracle's convolution") {
    const nlohmann::json rows = measured_rows("glow");
    CHECK(rows.size() == 5 + 2 * 3 + 4 + 3 * 2);
    for (const auto& row : rows) {
        if (row["bound"] == "none") {  // glow or glare changes the scene visibly
            CHECK(row["found"] < 38);
        }
    }
}

TEST_CASE("quality: skinning is that of double precision, for many joints and morph targets") {
    const nlohmann::json rows = measured_rows("skinning");
    CHECK(rows.size() == 2 * 2 + 9);
    CHECK(count_unbounded(rows) == 1);  // what linear blending loses
}

TEST_CASE("quality: characters keep their hands, heads and feet where they belong") {
    const nlohmann::json rows = measured_rows("characters");
    CHECK(rows.size() >= 8);
    CHECK(rows[0]["name"].get<std::string>().find(": ") != std::string::npos);
}

TEST_CASE("quality: caustics are those of ten million photons") {
    const nlohmann::json rows = measured_rows("caustics");
    CHECK(rows.size() == 2 + 3 + 1 + 2 + 1);
    CHECK(count_unbounded(rows) == 1);  // the coarsest grid, which bounds the others
}

TEST_CASE("quality: open water is the sum of its waves, with the right height and speed") {
    const nlohmann::json rows = measured_rows("water");
    CHECK(rows.size() == 3 * 2 + 2 + 2 + 1 + 3);
    CHECK(count_unbounded(rows) == 0);
}

TEST_CASE("quality: velocity is that of rays, and none where nothing has moved") {
    const nlohmann::json rows = measured_rows("velocity");
    CHECK(rows.size() == 5 * 2 + 5);
    for (const auto& row : rows) {
        if (row["bound"] == "none") {  // the scene moves
            CHECK(row["found"] > 10);
        }
    }
}

TEST_CASE("quality: ripples shift by the law and leave the foreground unchanged") {
    CHECK(measured_rows("ripple").size() == 6 * 4 + 1);
}

TEST_CASE(
    "quality: wrinkles keep the length of skin, and furrows of the GPU are those of the CPU") {
    const nlohmann::json rows = measured_rows("wrinkles");
    CHECK(rows.size() == 2 + 6 + 4 + 2 + 1 + 11 * 3);  // last: a face
    CHECK(count_unbounded(rows) == 4 + 11);            // statistics, and how much a face folds
}

}  // namespace limn::quality_test
