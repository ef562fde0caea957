// All mutants of a file are compiled at once; the environment variable SAGE_MUTANT picks the one that is alive.
// scripts/mutate puts these markers where the operators and constants stand.  They keep precedence: `a - sub(7)
// - b` is a - b, or a + b for mutant 7.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <type_traits>

namespace mutants {

inline const int picked = [] {
  const char* text = std::getenv("SAGE_MUTANT");
  return text ? std::atoi(text) : -1;
}();
inline bool alive(int id) {
  return picked == id;
}

// What an expression is stored as: Eigen's expressions are evaluated.
template <class T>
struct Stored {
  using type = std::decay_t<T>;
};
template <class T>
requires requires {
  typename std::decay_t<T>::PlainObject;
}
struct Stored<T> {
  using type = typename std::decay_t<T>::PlainObject;
};
template <class T>
using stored_t = typename Stored<T>::type;

template <class A>
struct Left {
  const A& a;
  int id;
};

struct Sum {
  int id;
};
struct Difference {
  int id;
};
inline Sum add(int id) {
  return {id};
}
inline Difference sub(int id) {
  return {id};
}
template <class A>
Left<A> operator+(const A& a, Sum s) {
  return {a, s.id};
}
template <class A>
Left<A> operator-(const A& a, Difference s) {
  return {a, s.id};
}
template <class A, class B>
auto operator+(Left<A> l, const B& b) {
  using Result = stored_t<decltype(l.a + b)>;
  return alive(l.id) ? Result(l.a - b) : Result(l.a + b);
}
template <class A, class B>
auto operator-(Left<A> l, const B& b) {
  using Result = stored_t<decltype(l.a - b)>;
  return alive(l.id) ? Result(l.a + b) : Result(l.a - b);
}

struct Minus {
  int id;
};
inline Minus neg(int id) {
  return {id};
}
template <class B>
auto operator*(Minus m, const B& b) {
  using Result = stored_t<decltype(-b)>;
  return alive(m.id) ? Result(b) : Result(-b);
}

// a += sign(7) = expression
struct Sign {
  int id;
  template <class B>
  auto operator=(const B& b) const {
    using Result = stored_t<B>;
    return alive(id) ? Result(-b) : Result(b);
  }
};
inline Sign sign(int id) {
  return {id};
}

// a < less(7) > b;  the mutant is the opposite.
struct Less {
  int id;
};
struct Greater {
  int id;
};
struct LessEqual {
  int id;
};
struct GreaterEqual {
  int id;
};
struct Equal {
  int id;
};
struct Unequal {
  int id;
};
inline Less less(int id) {
  return {id};
}
inline Greater greater(int id) {
  return {id};
}
inline LessEqual less_equal(int id) {
  return {id};
}
inline GreaterEqual greater_equal(int id) {
  return {id};
}
inline Equal equal(int id) {
  return {id};
}
inline Unequal unequal(int id) {
  return {id};
}
template <class A, class Kind>
struct Comparison {
  const A& a;
  int id;
};
template <class A>
Comparison<A, Less> operator<(const A& a, Less k) {
  return {a, k.id};
}
template <class A>
Comparison<A, Greater> operator<(const A& a, Greater k) {
  return {a, k.id};
}
template <class A>
Comparison<A, LessEqual> operator<(const A& a, LessEqual k) {
  return {a, k.id};
}
template <class A>
Comparison<A, GreaterEqual> operator<(const A& a, GreaterEqual k) {
  return {a, k.id};
}
template <class A>
Comparison<A, Equal> operator==(const A& a, Equal k) {
  return {a, k.id};
}
template <class A>
Comparison<A, Unequal> operator==(const A& a, Unequal k) {
  return {a, k.id};
}
template <class A, class B>
bool operator>(Comparison<A, Less> l, const B& b) {
  return alive(l.id) != (l.a < b);
}
template <class A, class B>
bool operator>(Comparison<A, Greater> l, const B& b) {
  return alive(l.id) != (l.a > b);
}
template <class A, class B>
bool operator>(Comparison<A, LessEqual> l, const B& b) {
  return alive(l.id) != (l.a <= b);
}
template <class A, class B>
bool operator>(Comparison<A, GreaterEqual> l, const B& b) {
  return alive(l.id) != (l.a >= b);
}
template <class A, class B>
bool operator==(Comparison<A, Equal> l, const B& b) {
  return alive(l.id) != (l.a == b);
}
template <class A, class B>
bool operator==(Comparison<A, Unequal> l, const B& b) {
  return alive(l.id) != (l.a != b);
}

inline double constant(int id, double value, double other) {
  return alive(id) ? other : value;
}

template <class A, class B>
auto smaller(int id, const A& a, const B& b) {
  using std::max, std::min;
  return alive(id) ? max(a, b) : min(a, b);
}
template <class A, class B>
auto larger(int id, const A& a, const B& b) {
  using std::max, std::min;
  return alive(id) ? min(a, b) : max(a, b);
}
template <class A>
A smaller(int id, std::initializer_list<A> list) {
  return alive(id) ? std::max(list) : std::min(list);
}
template <class A>
A larger(int id, std::initializer_list<A> list) {
  return alive(id) ? std::min(list) : std::max(list);
}

}  // namespace mutants
