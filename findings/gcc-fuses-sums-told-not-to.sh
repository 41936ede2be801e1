#!/usr/bin/env bash
# gcc told -ffp-contract=off fuses a product into a sum all the same, where sums alternate with differences.
#
# Expected: -ffp-contract=off means that no product is fused into what is added to it, so that a program gives the same bits
#   with and without FMA instructions; gcc's manual calls it the value that disables such contraction.
# Happens: where neighbours are a * b - c and a * b + c, as in a product of complex numbers, of quaternions or a cross product, the
#   vectoriser takes the pair as one "addsub", and with FMA allowed a product before it becomes vfmaddsub, one rounding in place of
#   two. From -O2 on, in straight code and in loops; sums alone, or differences alone, are left as they are, so that a small trial of
#   the option passes. A gcc that is set up for newer processors (x86-64-v3) does it with no option given; -mno-fma -mno-avx512f
#   keeps it from it.
# Seen with: gcc 12.2.0 (Debian 12.2.0-14+deb12u1), on x86-64 with FMA; box2d (issue 1086) tells of gcc 16.1 on RISC-V.
# Means: a library that was built with it for AVX2 and the same one built without differ in the last bit, and a chaotic
#   simulation becomes another one within seconds. Forbid the instructions, or look for vfmaddsub and vfmsubadd in what was built.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
gcc=12.2.0-14+deb12u1
apt-get download -qq "gcc-12=$gcc" "cpp-12=$gcc" "libgcc-12-dev=$gcc" binutils-x86-64-linux-gnu libbinutils libctf0 libctf-nobfd0 \
  libgprofng0 libmpc3 libmpfr6 libgmp10 libisl23 libzstd1 libjansson4 2>/dev/null
for package in *.deb; do dpkg-deb -x "$package" root; done
export LD_LIBRARY_PATH="$work/root/usr/lib/x86_64-linux-gnu:$work/root/lib/x86_64-linux-gnu"
tools="$work/root/usr/bin"
cat > turn.c <<'C'
void alternating(double *restrict out, const double *restrict a, const double *restrict b, const double *restrict c)
{
    out[0] = a[0] * b[0] - c[0];
    out[1] = a[1] * b[1] + c[1];
}
void sums(double *restrict out, const double *restrict a, const double *restrict b, const double *restrict c)
{
    out[0] = a[0] * b[0] + c[0];
    out[1] = a[1] * b[1] + c[1];
}
C
for name in plain fma forbidden; do
  case $name in
    plain) flags=() ;;
    fma) flags=(-march=x86-64-v3) ;;
    forbidden) flags=(-march=x86-64-v3 -mno-fma -mno-avx512f) ;;
  esac
  "$tools/gcc-12" -O2 -ffp-contract=off "${flags[@]}" -c -fPIC turn.c -o $name.o -B "$tools/x86_64-linux-gnu-"
  "$tools/x86_64-linux-gnu-ld" -shared $name.o -o $name.so
  echo "$name: fused instructions: $("$tools/x86_64-linux-gnu-objdump" -d $name.so | grep -c vfm || true)"
done
"$tools/gcc-12" --version | head -1
python3 - <<'PY'
import ctypes

Pair = ctypes.c_double * 2
a, b, c = Pair(1 + 2**-30, 1 + 2**-30), Pair(1 + 2**-30, 1 + 2**-30), Pair(1, -1)
seen = {}
for name in ("plain", "fma", "forbidden"):
    library = ctypes.CDLL(f"./{name}.so")
    for function in ("sums", "alternating"):
        out = Pair()
        library[function](out, a, b, c if function == "alternating" else Pair(-1, -1))
        seen[name, function] = tuple(out)
        print(f"{name:9} {function:11}", *(value.hex() for value in out))
two_roundings, one = (2**-29, 2**-29), (2**-29 + 2**-60, 2**-29 + 2**-60)
expected = {key: one if key == ("fma", "alternating") else two_roundings for key in seen}
if seen != expected:
    raise SystemExit("CHANGED: -ffp-contract=off keeps alternating sums apart, too, or fuses others")
PY
