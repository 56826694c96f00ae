#pragma once

namespace limn {

/// Makes every component and resource of the engine known by its name. Twice is no mistake.
void register_all_components();

}  // namespace limn
