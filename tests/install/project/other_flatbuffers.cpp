// Stands for a FlatBuffers of another version in the host: the same names, for which galactic's
// code must not be taken.
namespace flatbuffers {

struct String;

class Verifier {
 public:
  bool VerifyString(const String* text) const;
  bool VerifyTableStart(const unsigned char* table);
};

[[gnu::noinline]] inline bool Verifier::VerifyString(const String* /*text*/) const { return false; }
[[gnu::noinline]] inline bool Verifier::VerifyTableStart(const unsigned char* /*table*/) {
  return false;
}

}  // namespace flatbuffers

bool verifyWithTheOther() {
  flatbuffers::Verifier verifier;
  return verifier.VerifyString(nullptr) && verifier.VerifyTableStart(nullptr);
}
