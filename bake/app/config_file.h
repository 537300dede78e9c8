#pragma once
#include <CLI/CLI.hpp>

namespace galactic::bake {

/// Reads the file of --config: TOML, one KEY = VALUE for each option, by its long name. Throws
/// CLI::ConfigError with file and line on anything else, so that a misspelt line does not pass
/// unnoticed.
class ConfigFile final : public CLI::Config {
 public:
  /// `app` has the options, and must outlive the reader.
  explicit ConfigFile(const CLI::App& app) : app_(app) {}

  std::string to_config(const CLI::App* app, bool defaults, bool descriptions,
                        std::string prefix) const override;
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

 private:
  const CLI::App& app_;
};

}  // namespace galactic::bake
