// All probe files of a node, and which probe each is for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "node/files/probe_file.h"

namespace palpate {

/// A file applies to the probe that it names. A file without name applies to all probes that no
/// other file names.
class ProbeFiles {
 public:
  /// Reads all files. Fails at the first one that cannot be used (errors as of read_probe()), and
  /// if two are for the same probe.
  static Result<ProbeFiles> read(const std::vector<std::string>& paths);

  /// The file of this probe; nullptr if the probe has none.
  const QualifiedProbe* of(std::string_view probe) const;

  const std::vector<QualifiedProbe>& all() const { return probes_; }

 private:
  const QualifiedProbe* called(std::string_view name) const;

  std::vector<QualifiedProbe> probes_;
};

}  // namespace palpate
