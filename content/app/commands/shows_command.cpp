#include "content/app/commands/shows_command.h"

#include "content/load/files/json_document.h"
#include "content/load/level/level_show.h"
#include "content/load/level/technique_names.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace limn {
namespace {

/// A technique that `limn shows` lists. Those without a show are demonstrated by a command.
struct ListedTechnique {
    std::string_view id;
    std::string_view names;
    const FoundShow* show = nullptr;
};

std::vector<ListedTechnique> list_techniques(const std::vector<FoundShow>& shows) {
    std::vector<ListedTechnique> listed;
    for (const FoundShow& found : shows) {
        const auto* const named = std::find_if(
            std::begin(kTechniqueNames), std::end(kTechniqueNames),
            [&](const TechniqueName& name) { return name.id == found.show.technique; });
        const bool is_named = named != std::end(kTechniqueNames);
        listed.push_back({found.show.technique, is_named ? named->names : "", &found});
    }
    for (const TechniqueName& named : kTechniqueNames) {
        const bool is_shown = std::any_of(shows.begin(), shows.end(), [&](const FoundShow& found) {
            return found.show.technique == named.id;
        });
        if (!is_shown) {
            listed.push_back({named.id, named.names});
        }
    }
    return listed;
}

/// Whether a word of `text` begins with `start`, whatever the case.
bool has_word_from(std::string_view text, std::string_view start) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a))
               == std::tolower(static_cast<unsigned char>(b));
    };
    for (auto at = text.begin(); at != text.end(); ++at) {
        at = std::search(at, text.end(), start.begin(), start.end(), same);
        if (at == text.end()) {
            return false;
        }
        if (at == text.begin() || std::isalnum(static_cast<unsigned char>(*(at - 1))) == 0) {
            return true;
        }
    }
    return false;
}

/// The techniques whose id and names have all of the words; if none has, those whose text, too.
std::vector<ListedTechnique> matching_techniques(
    const std::vector<ListedTechnique>& all, const std::vector<std::string>& words) {
    std::vector<ListedTechnique> found;
    for (const bool with_text : {false, true}) {
        for (const ListedTechnique& listed : all) {
            const std::string text = fmt::format(
                "{} {} {}", listed.id, listed.names,
                with_text && listed.show != nullptr ? listed.show->show.text : "");
            if (std::all_of(words.begin(), words.end(), [&](const std::string& word) {
                    return has_word_from(text, word);
                })) {
                found.push_back(listed);
            }
        }
        if (!found.empty()) {
            break;
        }
    }
    return found;
}

void print_techniques(const std::vector<ListedTechnique>& listed) {
    const auto level_of = [](const ListedTechnique& technique) {
        return technique.show != nullptr ? technique.show->level.name : std::string("-");
    };
    std::size_t id = 0;
    std::size_t level = 0;
    for (const ListedTechnique& technique : listed) {
        id = std::max(id, technique.id.size());
        level = std::max(level, level_of(technique).size());
    }
    for (const ListedTechnique& technique : listed) {
        fmt::print(
            "{:<{}}  {:<{}}  {}. {}\n", technique.id, id, level_of(technique), level,
            technique.names,
            technique.show != nullptr ? technique.show->show.text
                                      : "Shown by a command, which TECHNIQUES.md names.");
    }
}

/// What a show changes, and the commands that render it on and off.
void print_show(const ListedTechnique& listed) {
    const FoundShow& found = *listed.show;
    const LevelShow& show = found.show;
    fmt::print(
        "{}: {}\n{}, at {} s: {}\n", show.technique, listed.names, found.level.name, show.time,
        show.text);
    if (show.equal) {
        fmt::print("On and off must look the same.\n");
    }
    if (show.set.kind == JsonKind::Object) {
        fmt::print("\nset {}\n", write_json(show.set));
    }
    fmt::print(
        "\noff {}\n", show.off.kind == JsonKind::Object ? write_json(show.off)
                                                        : std::string("without these changes"));
    fmt::print(
        "\nlimn play --show {0}\nlimn render --show {0} -o on.png\n"
        "limn render --show {0} --off -o off.png\n\nTECHNIQUES.md lists its code and its tests.\n",
        show.technique);
}

}  // namespace

Status run_shows(const std::vector<std::string>& words) {
    const std::vector<FoundShow> shows = LIMN_TRY(list_shows());
    std::vector<ListedTechnique> found = list_techniques(shows);
    if (words.size() == 1) {
        const auto exact =
            std::find_if(found.begin(), found.end(), [&](const ListedTechnique& technique) {
                return technique.id == words[0];
            });
        found = exact != found.end() ? std::vector{*exact} : matching_techniques(found, words);
    } else {
        found = matching_techniques(found, words);
    }
    if (found.empty()) {
        const std::string searched = fmt::format("{}", fmt::join(words, " "));
        std::vector<std::string_view> ids;
        for (const TechniqueName& named : kTechniqueNames) {
            ids.push_back(named.id);
        }
        return fail(
            "found no technique called {}, expected words of a line of `limn shows`{}; of a level "
            "of your own, `limn play FILE --show ID`",
            in_quotes(searched), did_you_mean(searched, ids));
    }
    if (found.size() == 1 && found[0].show != nullptr) {
        print_show(found[0]);
    } else {
        print_techniques(found);
    }
    return Done{};
}

}  // namespace limn
