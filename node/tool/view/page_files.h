// The page's files, compiled in (embed.cmake makes page_files.cpp of page/).
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
