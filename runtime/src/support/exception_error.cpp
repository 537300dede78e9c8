#include "support/exception_error.h"

#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "support/out_of_memory.h"

namespace galactic {

Error errorOfException() {
  try {
    throw;
  } catch (const ErrorException& failure) {
    return failure.error();
  } catch (const std::bad_alloc&) {
    return outOfMemory();
  } catch (const std::length_error&) {  // a vector that no memory could hold
    return outOfMemory();
  } catch (const std::filesystem::filesystem_error& failure) {
    return {ErrorCode::kIo, failure.path1().string(), failure.code().message()};
  } catch (const std::system_error& failure) {
    // A thread that cannot start lacks room for its stack.
    const bool lacks_memory = failure.code() == std::errc::resource_unavailable_try_again ||
                              failure.code() == std::errc::not_enough_memory;
    return lacks_memory ? outOfMemory() : Error{ErrorCode::kIo, "standard output", failure.what()};
  } catch (const std::exception& failure) {
    return {ErrorCode::kInternal, "internal error",
            std::string(failure.what()) + "; please report it"};
  } catch (...) {
    return {ErrorCode::kInternal, "internal error", "an unknown exception; please report it"};
  }
}

}  // namespace galactic
