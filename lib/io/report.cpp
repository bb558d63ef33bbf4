// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/report.hpp>

#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

using json = nlohmann::ordered_json;

double finite(const char* key, double value) {
  if (!std::isfinite(value)) throw Error(ErrorCode::numerical, std::string("report: ") + key + " is not finite");
  return value;
}

json finite_or_null(const char* key, const std::optional<double>& value) {
  return value ? json(finite(key, *value)) : json(nullptr);
}

}  // namespace

std::string to_json(const RunReport& r) {
  const auto& s = r.seconds;
  return json{{"version", r.version},
              {"mesh", {{"vertices", r.vertices}, {"triangles", r.triangles}, {"volume", finite("volume", r.volume)}}},
              {"landmarks", r.landmarks},
              {"poisson", finite_or_null("poisson", r.poisson)},
              {"solver", r.solver},
              {"tolerance", finite_or_null("tolerance", r.tolerance)},
              {"estimated_error", finite_or_null("estimated_error", r.estimated_error)},
              {"residual", finite_or_null("residual", r.residual)},
              {"iterations", r.iterations ? json(*r.iterations) : json(nullptr)},
              {"threads", r.threads},
              {"seconds",
               {{"read", finite("seconds.read", s.read)},
                {"assemble", finite("seconds.assemble", s.assemble)},
                {"factor", finite("seconds.factor", s.factor)},
                {"solve", finite("seconds.solve", s.solve)},
                {"total", finite("seconds.total", s.total)}}},
              {"peak_bytes", r.peak_bytes},
              {"predicted", r.predicted ? json{{"seconds", finite("predicted.seconds", r.predicted->seconds)},
                                               {"bytes", r.predicted->bytes}}
                                        : json(nullptr)}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string to_text(const RunReport& r) {
  std::ostringstream out;
  out.precision(4);
  const auto& s = r.seconds;
  out << "mesh       " << r.vertices << " vertices, " << r.triangles << " triangles, volume " << r.volume << '\n'
      << "landmarks  " << r.landmarks;
  if (r.poisson) out << ", Poisson's ratio " << *r.poisson;
  out << "\nsolver     " << r.solver << ", " << r.threads << (r.threads == 1 ? " thread" : " threads");
  if (r.tolerance) out << ", tolerance " << *r.tolerance;
  if (r.iterations) out << ", " << *r.iterations << (*r.iterations == 1 ? " iteration" : " iterations");
  out << '\n';
  if (r.estimated_error) out << "error      " << *r.estimated_error << " (estimated, of the response)\n";
  if (r.residual) out << "residual   " << *r.residual << '\n';
  out << "seconds    " << s.total << " (read " << s.read << ", assemble " << s.assemble << ", factor " << s.factor
      << ", solve " << s.solve << ")\n"
      << "memory     " << static_cast<double>(r.peak_bytes) / (1024 * 1024) << " MiB at most\n";
  return out.str();
}

std::int64_t peak_resident_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return std::int64_t{1024} * usage.ru_maxrss;  // Linux counts in KiB
}

}  // namespace skinbem
