// Drivers accept code that the language forbids: glslangValidator checks every shader in many
// variants.

#include "render/gpu/shader_source.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace limn::glslang_test {
namespace {

/// A definition with a value, for stages whose own file mentions it.
struct KnownDefine {
    std::string_view name;
    std::vector<const char*> values;  ///< each is tried in turn
};
const std::vector<KnownDefine>& known_defines() {
    static const std::vector<KnownDefine> known = {
        {"AOV", {"0", "1", "2", "3", "4", "5"}},
        {"SKY_KIND", {"0", "1", "2", "3", "4"}},
        {"SOURCE", {"0", "1", "2"}},
        {"TONE_CURVE", {"0", "1", "2", "3", "4", "5"}},
        {"DEFORM_FLAGS", {"0", "7", "63"}},
        {"RADIUS", {"3", "15"}},
        {"SIZE", {"32u", "256u"}},
        {"SINGLE_LIGHTS", {"1", "4"}},
        {"ENVIRONMENT_LAYOUT", {"0", "1", "2", "3"}},
    };
    return known;
}

/// What only a shader's own text defines: that it interpolates light and has no normals, or lights
/// all corners of a particle at once.
constexpr const char* kOwnDefines[] = {"LIT_AT_VERTICES", "MEAN_OF_CORNERS", "TESSELLATED"};

std::string text_of(const std::string& path, const std::vector<gpu::ShaderDefine>& defines) {
    const Result<gpu::ShaderSource> source =
        gpu::assemble_shader(gpu::ShaderFiles::standard(), path, defines);
    REQUIRE_MESSAGE(source.ok(), (source ? "" : source.error().message));
    return source->text;
}

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string_view first_word(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t("), text.size()));
    const auto* const end = std::find_if_not(text.begin(), text.end(), is_word);
    return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

/// Names that preprocessor conditions test and the text does not define itself.
std::set<std::string> tested_names(std::string_view text) {
    std::set<std::string> tested;
    std::set<std::string> own;
    const auto words_after = [&](std::string_view before, std::set<std::string>& words) {
        for (std::size_t at = text.find(before); at != std::string_view::npos;
             at = text.find(before, at + 1)) {
            words.emplace(first_word(text.substr(at + before.size())));
        }
    };
    words_after("#ifdef ", tested);
    words_after("#ifndef ", tested);
    words_after("defined(", tested);
    words_after("#define ", own);
    for (const std::string& name : own) {
        tested.erase(name);
    }
    return tested;
}

bool has_word(std::string_view text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string_view::npos;
         at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        if ((at == 0 || !is_word(text[at - 1])) && (end == text.size() || !is_word(text[end]))) {
            return true;
        }
    }
    return false;
}

using Defines = std::vector<gpu::ShaderDefine>;

/// Without definitions, with all, and with half of them each: those whose index has a certain bit,
/// or lacks it. Any two definitions are so tried together, without each other, and neither: a
/// pairwise covering array of 2 log2(n) + 2 rows.
std::vector<Defines> variants_of(const std::set<std::string>& names) {
    std::vector<Defines> variants(2);
    for (const std::string& name : names) {
        variants[1].push_back({name});
    }
    const Defines all = variants[1];
    for (std::size_t bit = 1; bit < all.size(); bit *= 2) {
        for (const std::size_t wanted : {bit, std::size_t{0}}) {
            variants.emplace_back();
            for (std::size_t i = 0; i < all.size(); ++i) {
                if ((i & bit) == wanted) {
                    variants.back().push_back(all[i]);
                }
            }
        }
    }
    return variants;
}

/// `variants` with values of the known_defines that `text`, the stage's own file, mentions: the
/// first two (without any definition, and with all) with every combination of values, the others
/// with one combination each, in turn.
std::vector<Defines> with_values(const std::vector<Defines>& variants, std::string_view text) {
    std::vector<Defines> combinations = {{}};
    for (const KnownDefine& known : known_defines()) {
        if (!has_word(text, known.name)) {
            continue;
        }
        std::vector<Defines> more;
        for (const Defines& combination : combinations) {
            for (const char* value : known.values) {
                more.push_back(combination);
                more.back().push_back({std::string(known.name), value});
            }
        }
        combinations = std::move(more);
    }
    std::vector<Defines> valued;
    const auto add = [&](Defines variant, const Defines& values) {
        variant.insert(variant.end(), values.begin(), values.end());
        valued.push_back(std::move(variant));
    };
    for (std::size_t i = 0; i < variants.size(); ++i) {
        if (i < 2) {
            for (const Defines& values : combinations) {
                add(variants[i], values);
            }
        } else {
            add(variants[i], combinations[i % combinations.size()]);
        }
    }
    return valued;
}

std::string describe(const Defines& defines) {
    std::string text;
    for (const gpu::ShaderDefine& define : defines) {
        text += fmt::format(" {}={}", define.name, define.value);
    }
    return text;
}

/// The errors that glslangValidator reports for a stage, "" if none.
std::string validate(const test::TemporaryFolder& folder, const std::string& stage) {
    std::set<std::string> names = tested_names(text_of(stage, {}));
    for (const char* name : kOwnDefines) {
        names.erase(name);
    }
    for (const KnownDefine& known : known_defines()) {
        names.erase(std::string(known.name));
    }
    const std::string own = gpu::ShaderFiles::standard().read(stage).value_or("");
    const std::vector<Defines> variants = with_values(variants_of(names), own);
    const std::string extension = std::filesystem::path(stage).extension().string();
    std::string command = "glslangValidator";
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const std::string file = folder.file(fmt::format("{}{}", i, extension));
        std::ofstream(file) << text_of(stage, variants[i]);
        command += " " + file;
    }
    const std::string log = folder.file("log");
    if (std::system(fmt::format("{} >{} 2>&1", command, log).c_str()) == 0) {
        return {};
    }
    std::string errors;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        errors += fmt::format("{}{}:{}\n", i, extension, describe(variants[i]));
    }
    std::ifstream stream(log);
    return errors + std::string{std::istreambuf_iterator<char>(stream), {}};
}

TEST_CASE("glslang: every shader is valid with any two of its definitions, and without") {
    if (std::system("glslangValidator --version >/dev/null 2>&1") != 0) {
        std::printf("SKIP: glslangValidator is not installed\n");
        return;
    }
    int stages = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(LIMN_SOURCE_DIR "/render/shaders")) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".vert" && extension != ".frag" && extension != ".geom"
            && extension != ".comp" && extension != ".tesc") {
            continue;
        }
        const test::TemporaryFolder folder;
        const std::string stage = entry.path().filename().string();
        const std::string errors = validate(folder, stage);
        CHECK_MESSAGE(errors.empty(), stage, "\n", errors);
        ++stages;
    }
    CHECK(stages > 50);
}

}  // namespace
}  // namespace limn::glslang_test
