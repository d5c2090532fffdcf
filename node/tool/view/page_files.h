// The files of the page, compiled into the program (embed.cmake makes page_files.cpp from page/).
#pragma once

#include <span>
#include <string_view>

namespace palpate {

struct PageFile {
  std::string_view name;
  std::string_view content;
};

std::span<const PageFile> page_files();

}  // namespace palpate
