#include "bench/quality/characters_quality.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace limn {
namespace {

struct CharacterPart {
    std::string_view name;
    MeasureQuality measure;
};

/// Filled before main.
std::vector<CharacterPart>& character_parts() {
    static std::vector<CharacterPart> parts;
    return parts;
}

Status measure_characters(HeadlessRenderer& headless, QualityReport& report) {
    std::vector<CharacterPart> parts = character_parts();
    std::ranges::sort(parts, {}, &CharacterPart::name);
    for (const CharacterPart& part : parts) {
        QualityReport own;
        LIMN_TRY(part.measure(headless, own));
        for (QualityRow& row : own.rows) {
            row.name = std::string(part.name) + ": " + row.name;
            report.rows.push_back(std::move(row));
        }
        for (QualityImage& image : own.images) {
            image.title = std::string(part.name) + ": " + image.title;
            report.images.push_back(std::move(image));
        }
        report.html += own.html;
    }
    return Done{};
}

const RegisterQuality kRegisteredCharacters(
    "characters", "closed forms, kinematics in double precision", measure_characters);

}  // namespace

RegisterCharacterPart::RegisterCharacterPart(std::string_view name, MeasureQuality measure) {
    character_parts().push_back({name, measure});
}

}  // namespace limn
