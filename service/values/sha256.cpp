#include "service/values/sha256.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <stdexcept>

namespace lumulus::service {
namespace {

constexpr std::size_t digestBytes = 32;

void require(int result) {
    if (result != 1) throw std::runtime_error("SHA-256 fails");
}

}  // namespace

struct Sha256::State {
    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
    require(EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr));
}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) {
    require(EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size()));
}

std::string Sha256::hex() {
    std::array<unsigned char, digestBytes> digest{};
    require(EVP_DigestFinal_ex(state_->context.get(), digest.data(), nullptr));
    static constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : digest) {
        text += digits[byte >> 4U];
        text += digits[byte & 15U];
    }
    return text;
}

std::string sha256Hex(std::span<const std::byte> bytes) {
    Sha256 hash;
    hash.update(bytes);
    return hash.hex();
}

bool equalSecrets(std::string_view a, std::string_view b) {
    // digests have one length, whatever the secrets'
    const std::string left = sha256Hex(std::as_bytes(std::span(a))), right = sha256Hex(std::as_bytes(std::span(b)));
    return CRYPTO_memcmp(left.data(), right.data(), left.size()) == 0;
}

}  // namespace lumulus::service
