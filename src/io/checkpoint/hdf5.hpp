#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>

namespace treacle {

/// A failed call of the HDF5 library; the message is the library's own, of the innermost place.
struct Hdf5Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Passes the result of a call on. Errors: Hdf5Error where it is negative, which is how HDF5 reports failure.
template <class Result>
Result hdf5Checked(Result result) {
  if (result >= 0) return result;
  std::string text = "HDF5 failed";
  const auto takeInnermost = [](unsigned depth, const H5E_error2_t* error, void* target) -> herr_t {
    if (depth == 0 && error->desc) *static_cast<std::string*>(target) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, takeInnermost, &text);
  throw Hdf5Error(text);
}

/// Owner of an identifier, closed by the function of its kind. Errors: Hdf5Error for a negative one.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Close close) : id_(hdf5Checked(id)), close_(close) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  ~Hdf5Handle() { close_(id_); }

  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// While it lives, HDF5 prints nothing to stderr.
class Hdf5Silence {
 public:
  Hdf5Silence() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &target_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;
  ~Hdf5Silence() { H5Eset_auto2(H5E_DEFAULT, print_, target_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* target_ = nullptr;
};

}  // namespace treacle
