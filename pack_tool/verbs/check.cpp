#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>

#include "pack_tool/check/find_packs.h"
#include "pack_tool/check/junit.h"
#include "pack_tool/check/pack_checker.h"
#include "pack_tool/describe/pack_description.h"
#include "pack_tool/support/output_file.h"
#include "pack_tool/verbs/verbs.h"
#include "support/exception_error.h"
#include "support/files/output_files.h"
#include "support/threads/workers.h"

namespace galactic::pack_tool {

namespace {

namespace fs = std::filesystem;

/// Something to check: a pack, or the reason why there is none.
struct Task {
  fs::path pack;
  std::optional<CheckedPack> done;
};

/// One name for each file, whatever way leads to it.
fs::path nameOf(const fs::path& file) {
  std::error_code unknown;
  const fs::path name = fs::weakly_canonical(file, unknown);
  return unknown ? file : name;
}

/// Each pack once, however often it is named.
std::vector<Task> tasksOf(const std::vector<fs::path>& arguments) {
  std::vector<Task> tasks;
  tasks.reserve(arguments.size());
  std::set<fs::path> named;
  const auto add = [&](const fs::path& pack) {
    if (named.insert(nameOf(pack)).second) tasks.push_back({pack, std::nullopt});
  };
  for (const fs::path& argument : arguments) {
    std::error_code unknown;
    if (!fs::is_directory(argument, unknown)) {
      add(argument);
      continue;
    }
    const auto found = findPacks(argument);
    if (!found) {
      tasks.push_back({argument, badPack(argument.string(), found.error())});
      continue;
    }
    for (const fs::path& pack : *found) add(pack);
  }
  return tasks;
}

/// What becomes of a pack does not depend on which thread checks it.
void check(std::span<Task* const> tasks, std::uint32_t threads) {
  detail::forEachPart(threads, tasks.size(), [&](std::size_t n) {
    const fs::path& pack = tasks[n]->pack;
    try {
      tasks[n]->done = checkPack(pack);
    } catch (...) {
      Error error = errorOfException();
      if (error.code == ErrorCode::kInternal) error.where = pack.string();
      tasks[n]->done = badPack(pack.string(), error);
    }
  });
}

bool isWorld(const fs::path& pack) {
  const auto opened = PackFile::open(pack, Trust::kTrusted);
  return opened && opened->kind() == PackKind::kWorld;
}

/// Each pack once, in the order of the tasks: those that a world lists are checked with it.
std::vector<CheckedPack> checkAll(std::vector<Task> tasks, std::uint32_t threads) {
  std::vector<Task*> worlds;
  std::vector<Task*> others;
  for (Task& task : tasks) {
    if (!task.done) (isWorld(task.pack) ? worlds : others).push_back(&task);
  }
  check(worlds, threads);
  std::set<fs::path> listed;
  for (const Task* world : worlds) {
    for (const CheckedPack& pack : world->done->listed) listed.insert(nameOf(pack.file));
  }
  std::erase_if(others, [&](const Task* task) { return listed.contains(nameOf(task->pack)); });
  check(others, threads);
  std::vector<CheckedPack> checked;
  for (Task& task : tasks) {
    if (task.done) checked.push_back(std::move(*task.done));
  }
  return checked;
}

/// Prints a line for each pack, those of a world before it.
class Lines {
 public:
  Lines(const CheckOptions& options, const Console& console)
      : is_shown_(options.form == OutputForm::kText && !options.is_quiet), console_(console) {}

  void print(const CheckedPack& pack) {
    for (const CheckedPack& listed : pack.listed) {
      // Worlds may share packs.
      if (listed.finding || told_.insert(nameOf(listed.file)).second) print(listed);
    }
    if (pack.finding) {
      const auto& [code, error] = *pack.finding;
      reportError(console_, {error.code, error.where, fmt::format("{} [{}]", error.message, code)});
    } else if (is_shown_) {
      console_.out << fmt::format("{}: ok\n", printable(pack.file));
    }
  }

 private:
  bool is_shown_;
  const Console& console_;
  /// Packs of worlds that are good.
  std::set<fs::path> told_;
};

/// File and whether it is ok, then kind and size, or exit code, code, place and message.
Json entryOf(const CheckedPack& pack) {
  Json entry{{"file", pack.file}, {"ok", !pack.finding}};
  if (pack.finding) {
    const auto& [code, error] = *pack.finding;
    entry["exit_code"] = static_cast<int>(error.code);
    entry["code"] = code;
    entry["where"] = error.where;
    entry["message"] = error.message;
  } else {
    entry["kind"] = packKindName(pack.kind);
    entry["bytes"] = pack.bytes;
  }
  if (!pack.is_world) return entry;
  entry["packs"] = Json::array();
  for (const CheckedPack& listed : pack.listed) entry["packs"].push_back(entryOf(listed));
  return entry;
}

/// Refuses to write the report over a pack that was checked.
Result<void> checkReport(const std::vector<CheckedPack>& packs, const fs::path& report) {
  for (const CheckedPack& pack : packs) {
    if (isSameFile(pack.file, report)) {
      return fail(ErrorCode::kInvalidInput, report.string(),
                  "is one of the packs; write to another file");
    }
    if (auto checked = checkReport(pack.listed, report); !checked) return checked;
  }
  return {};
}

Result<void> writeJunit(const std::vector<CheckedPack>& packs, const fs::path& report) {
  if (report.empty()) return {};
  if (auto checked = checkReport(packs, report); !checked) return checked;
  return writeOutput(report, junitText(packs));
}

}  // namespace

int runCheck(const CheckOptions& options, const Console& console) {
  const std::vector<CheckedPack> packs =
      checkAll(tasksOf(options.packs), detail::threadCount(options.threads));
  int exit_code = kExitOk;
  Json report = Json::array();
  Lines lines(options, console);
  for (const CheckedPack& pack : packs) {
    lines.print(pack);
    exit_code = worseExit(exit_code, pack.exitCode());
    if (options.form == OutputForm::kJson) report.push_back(entryOf(pack));
  }
  if (options.form == OutputForm::kJson) console.out << jsonText(report);
  const auto written = writeJunit(packs, options.junit);
  return written ? exit_code : worseExit(exit_code, reportError(console, written.error()));
}

}  // namespace galactic::pack_tool
