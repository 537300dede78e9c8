#pragma once

// The version of the library, for #if. Until 1.0, minor versions may change the interface. The
// build reads these three lines: the version stands nowhere else.
#define GALACTIC_VERSION_MAJOR 0
#define GALACTIC_VERSION_MINOR 1
#define GALACTIC_VERSION_PATCH 0
