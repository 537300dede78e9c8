#include "view/page.h"

// The assembler copies the file as it is: a literal of its size would take the compiler a minute.
asm(R"(
  .section .rodata
  .balign 16
  .local galactic_page_begin
galactic_page_begin:
  .incbin ")" GALACTIC_PAGE R"("
  .local galactic_page_end
galactic_page_end:
  .byte 0
  .previous
)");

extern "C" {
extern const char galactic_page_begin[];
extern const char galactic_page_end[];
}

namespace galactic {

std::string_view pageTemplate() {
  return {galactic_page_begin, static_cast<std::size_t>(galactic_page_end - galactic_page_begin)};
}

}  // namespace galactic
