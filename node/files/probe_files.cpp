#include "node/files/probe_files.h"

#include <algorithm>
#include <utility>

#include "node/files/printable.h"

namespace palpate {

Result<ProbeFiles> ProbeFiles::read(const std::vector<std::string>& paths) {
  ProbeFiles files;
  for (const std::string& path : paths) {
    Result<QualifiedProbe> probe = read_probe(path);
    if (!probe) return Result<ProbeFiles>::fail(std::move(probe.error));
    const std::string& name = probe.value->described.name();
    if (const QualifiedProbe* other = files.called(name)) {
      return Result<ProbeFiles>::fail(
          path + ": name: " + (name.empty() ? "none is given" : printable(name)) + ", and so in " +
          other->file + ": a probe has one file");
    }
    files.probes_.push_back(*std::move(probe.value));
  }
  return Result<ProbeFiles>::ok(std::move(files));
}

const QualifiedProbe* ProbeFiles::of(std::string_view probe) const {
  const QualifiedProbe* own = called(probe);
  return own != nullptr ? own : called("");
}

const QualifiedProbe* ProbeFiles::called(std::string_view name) const {
  const auto found = std::find_if(probes_.begin(), probes_.end(), [&](const QualifiedProbe& probe) {
    return probe.described.name() == name;
  });
  return found == probes_.end() ? nullptr : &*found;
}

}  // namespace palpate
