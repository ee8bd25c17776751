/** Criteria as the program has them: indices of each mode into `out`, of a stress 11, 22, 33, 12, 23, 31 and strengths. */
const CRITERIA = (() => {
  const square = (v) => v * v;
  const along = (s, r) => (s[3] * s[3] + s[5] * s[5]) / (r.S12 * r.S12);
  const hashin = (s, r, out, product) => {
    const sum = s[1] + s[2], half = 0.5 * (s[1] - s[2]), s23 = r.S23 * r.S23, a = along(s, r), across = s[4] * s[4];
    out[0] = s[0] >= 0 ? square(s[0] / r.Xt) + a : 0;
    out[1] = s[0] >= 0 ? 0 : square(s[0] / r.Xc);
    out[2] = sum >= 0 ? square(sum / r.Yt) + (across + product * s[1] * s[2]) / s23 + a : 0;
    out[3] = sum >= 0 ? 0 : (half * half + across) / s23 + a;
    return sum;
  };
  const shear = (s, r) => square(s[5] / r.S13) + square(s[4] / r.S23);
  const signed = (v, tension, compression) => [v >= 0 ? v / tension : 0, v >= 0 ? 0 : -v / compression];
  return {
    "hashin-report": (s, r, out, { plus }) => { hashin(s, r, out, plus ? 1 : -1); },
    "hashin-1980": (s, r, out) => {
      const sum = hashin(s, r, out, -1);
      if (sum < 0) out[3] += (r.Yc * r.Yc / (4 * r.S23 * r.S23) - 1) * sum / r.Yc;
    },
    "max-stress": (s, r, out) => {
      [out[0], out[1]] = signed(s[0], r.Xt, r.Xc);
      [out[2], out[3]] = signed(s[1], r.Yt, r.Yc);
      [out[4], out[5]] = signed(s[2], r.Yt, r.Yc);
      [out[6], out[7], out[8]] = [Math.abs(s[4]) / r.S23, Math.abs(s[5]) / r.S12, Math.abs(s[3]) / r.S12];
    },
    octahedral: (s, r, out) => {
      const [a, b, c] = [s[0] - s[1], s[1] - s[2], s[2] - s[0]];
      out[0] = ((a * a + b * b + c * c) / 6 + s[3] * s[3] + s[4] * s[4] + s[5] * s[5]) / (r.S12 * r.S12);
    },
    "quadratic-stress": (s, r, out) => { out[0] = square(Math.max(0, s[2]) / r.Zt) + shear(s, r); },
    "max-stress-interface": (s, r, out) => {
      [out[0], out[1], out[2]] = [Math.max(0, s[2]) / r.Zt, Math.abs(s[5]) / r.S13, Math.abs(s[4]) / r.S23];
    },
    "brewer-lagace": (s, r, out) => { out[0] = square(s[2] / (s[2] >= 0 ? r.Zt : r.Zc)) + shear(s, r); },
  };
})();

/** Stresses by six `rows` of a place and the coordinates `q` of samples `s` and `t`, one after the other. */
function stressesOf(rows, q, s, t, out) {
  const size = rows.length / 6, r1 = size, r2 = 2 * size, r3 = 3 * size, r4 = 4 * size, r5 = 5 * size, from = s * size, to = t * size;
  let a = 0, b = 0, c = 0, d = 0, e = 0, f = 0, a2 = 0, b2 = 0, c2 = 0, d2 = 0, e2 = 0, f2 = 0;
  for (let i = 0; i < size; i += 1) {
    const x = q[from + i], y = q[to + i];
    const v = rows[i], v1 = rows[r1 + i], v2 = rows[r2 + i], v3 = rows[r3 + i], v4 = rows[r4 + i], v5 = rows[r5 + i];
    a += v * x; b += v1 * x; c += v2 * x; d += v3 * x; e += v4 * x; f += v5 * x;
    a2 += v * y; b2 += v1 * y; c2 += v2 * y; d2 += v3 * y; e2 += v4 * y; f2 += v5 * y;
  }
  out[0] = a; out[1] = b; out[2] = c; out[3] = d; out[4] = e; out[5] = f;
  out[6] = a2; out[7] = b2; out[8] = c2; out[9] = d2; out[10] = e2; out[11] = f2;
}

/** The first time at which each mode reaches index 1 at the places that are carried, and its largest index: of every criterion and mode
 * { criterion, mode, index, time, place }, `time` null where it stays below 1. Between two samples an index is a straight line. */
function judge({ plate, criteria }, operator, { times, q }, strengths) {
  const size = plate.load.length, stress = new Float64Array(6), pair = new Float64Array(12), found = [];
  const modes = criteria.map((criterion) => criterion.modes.map((mode) => {
    const of = { criterion: criterion.name, mode, index: 0, time: null, place: null };
    found.push(of);
    return of;
  }));
  const before = modes.map((of) => new Float64Array(of.length)), now = new Float64Array(Math.max(1, ...modes.map((of) => of.length)));
  plate.places.forEach((place, k) => {
    const asked = criteria.map((c, i) => [c, CRITERIA[c.plugin], modes[i], before[i]]).filter(([c]) => c.interface === place.interface);
    const rows = operator.subarray(6 * size * k, 6 * size * (k + 1)), rest = plate.residual, r = strengths[place.material];
    for (let t = 0; t < times.length; t += 1) {
      // Two samples at a time: each number of the rows is read once for both.
      if (t % 2 === 0) stressesOf(rows, q, t, Math.min(t + 1, times.length - 1), pair);
      for (let i = 0; i < 6; i += 1) stress[i] = pair[6 * (t % 2) + i] + rest[6 * k + i];
      for (const [criterion, indices, of, was] of asked) {
        indices(stress, r, now, criterion);
        for (let i = 0; i < of.length; i += 1) {
          const mode = of[i], index = now[i];
          if (index > mode.index) { mode.index = index; if (mode.time === null) mode.place = place; }
          if (index >= 1 && (t === 0 || was[i] < 1)) {
            const share = t === 0 ? 0 : (1 - was[i]) / (index - was[i]);
            const time = t === 0 ? times[0] : times[t - 1] + share * (times[t] - times[t - 1]);
            if (mode.time === null || time < mode.time) { mode.time = time; mode.place = place; }
          }
          was[i] = index;
        }
      }
    }
  });
  return found;
}
