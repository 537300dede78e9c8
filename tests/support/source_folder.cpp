#include "support/source_folder.h"

std::filesystem::path galactic::test::sourceFolder() { return GALACTIC_SOURCE_DIR; }
