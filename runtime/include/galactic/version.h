#pragma once

// The version of the library, for #if. Until 1.0, minor versions may change the interface. The
// build reads these three lines, the only place that has the version.
#define GALACTIC_VERSION_MAJOR 0
#define GALACTIC_VERSION_MINOR 1
#define GALACTIC_VERSION_PATCH 0
