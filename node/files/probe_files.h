// The probe files of a node: which is whose.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "node/files/probe_file.h"

namespace palpate {

/// Each file is for the probe that it names; one without a name for all that no other names.
class ProbeFiles {
 public:
  /// Fails at the first file that cannot be used, as read_probe() does, and where two are for the
  /// same probe.
  static Result<ProbeFiles> read(const std::vector<std::string>& paths);

  /// nullptr = nobody has qualified it.
  const QualifiedProbe* of(std::string_view probe) const;

  const std::vector<QualifiedProbe>& all() const { return probes_; }

 private:
  const QualifiedProbe* called(std::string_view name) const;

  std::vector<QualifiedProbe> probes_;
};

}  // namespace palpate
