// Where an FMU's resources are: FMI 2 gives a URI, FMI 3 a path that ends in a separator.
#pragma once

#include <cstdlib>
#include <string>

namespace wingbeat::fmu {

inline std::string path_of_uri(std::string uri) {
  for (const char* head : {"file://localhost/", "file:///", "file:/"}) {
    const std::string start = head;
    if (uri.compare(0, start.size(), start) != 0) continue;
    uri = uri.substr(start.size() - 1);
    break;
  }
  std::string path;
  for (std::size_t n = 0; n < uri.size(); ++n) {
    if (uri[n] == '%' && n + 2 < uri.size()) {
      path += char(std::strtol(uri.substr(n + 1, 2).c_str(), nullptr, 16));
      n += 2;
    } else {
      path += uri[n];
    }
  }
#ifdef _WIN32
  if (path.size() > 2 && path[0] == '/' && path[2] == ':') path.erase(0, 1);
#endif
  while (path.size() > 1 && (path.back() == '/' || path.back() == '\\')) path.pop_back();
  return path;
}

}  // namespace wingbeat::fmu
