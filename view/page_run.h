#pragma once
#include "view/page.h"

namespace galactic {

/// Writes a run into the data of a page: poses as whole numbers of 0.1 mm and 1/32767, joints of
/// 0.0001 radians or meters, each relative to the step before.
void writeRun(JsonWriter& json, std::string_view key, PageData& data, const PageRun& run);

}  // namespace galactic
