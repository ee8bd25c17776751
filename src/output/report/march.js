/** A contact law: force [F, dF/dα] at an indentation, energy [stored, dissipated] and what a step commits; `history` is [α_max, whether
 * the curve of loading is followed below it, dissipated]. The laws are those of the program (linear, hertz, sun-yang). */
function makeLaw({ k, n, unloading }) {
  const loading = (a) => {
    if (a <= 0) return [0, 0];
    const slope = k * (n === 1.5 ? Math.sqrt(a) : a ** (n - 1));
    return [slope * a, n * slope];
  };
  const work = (a) => loading(a)[0] * a / (n + 1);
  if (!unloading) return { force: (_, a) => loading(a), energy: (_, a) => [work(a), 0], commit() {} };
  const { m, critical, beta, reload_by_n: reloadByN } = unloading;
  const curve = (most, p) => {
    const dent = most > 0 ? most - most * Math.min(1, critical / most) ** beta : 0;
    const depth = most - dent, peak = loading(most)[0];
    const at = (a) => {
      if (a <= dent) return [0, 0];
      const x = (a - dent) / depth, slope = peak * x ** (p - 1);
      return [slope * x, p * slope / depth];
    };
    return { dent, at, work: (a) => at(a)[0] * (a - dent) / (p + 1) };
  };
  const present = (h) => curve(h[0], h[1] ? n : m);
  const energy = (h, a) => {
    const before = present(h);
    if (a <= h[0]) return [before.work(a), h[2]];
    const done = before.work(h[0]) + work(a) - work(h[0]), stored = curve(a, m).work(a);
    return [stored, h[2] + done - stored];
  };
  return {
    force: (h, a) => a <= h[0] ? present(h).at(a) : loading(a),
    energy,
    commit(h, a) {
      if (a > h[0]) [h[0], h[1], h[2]] = [a, 0, energy(h, a)[1]];
      else if (reloadByN && h[0] > 0 && a <= present(h).dent) h[1] = 1;
    },
  };
}

/** Solves α + soft F(α) = free for F: Newton's method inside a bracket, because F never falls. */
function contactForce(law, history, free, soft) {
  const [force, tangent] = law.force(history, free);
  if (force === 0) return 0;
  let low = free - soft * force, high = free, a = free - soft * force / (1 + soft * tangent);
  for (let calls = 2; calls < 200; calls += 1) {
    const [f, t] = law.force(history, a);
    const residual = a + soft * f - free;
    if (residual > 0) high = a; else low = a;
    const correction = -residual / (1 + soft * t), next = a + correction;
    if (Math.abs(next - a) <= 1e-15 * (Math.abs(free) + Math.abs(a)) || !Number.isFinite(residual)) return f + t * correction;
    const halve = calls > 20 && calls % 2 === 0;
    a = next > low && next < high && !halve ? next : 0.5 * (low + high);
  }
  return (free - a) / soft;
}

/** Marches M q̈ + C q̇ + K q = F p and m z̈ = −F by Newmark's method: force and deflection after every step, coordinates and energies at
 * every sample. `q` holds the coordinates of the samples one after the other. */
function marchImpact({ impact, plate }, law, mass, velocity) {
  const { start, step: h, steps, sample, until_separation: untilSeparation, beta, gamma } = impact;
  const [K, M, p] = [plate.stiffness, plate.mass, plate.load].map((v) => Float64Array.from(v)), size = K.length;
  const C = Float64Array.from(plate.damping.length ? plate.damping : K, (c) => plate.damping.length ? c : 0);
  const cm = 1 / (beta * h * h), cc = gamma / (beta * h);
  const S = K.map((k, i) => k + cm * M[i] + cc * C[i]), X = p.map((v, i) => S[i] === 0 ? 0 : v / S[i]);
  const soft = p.reduce((sum, v, i) => sum + v * X[i], 0) + 1 / (cm * mass);
  const [u, v, a, d] = [0, 1, 2, 3].map(() => new Float64Array(size)), history = [0, 0, 0];
  let z = -velocity * start, vz = velocity, az = 0;
  const forces = new Float64Array(steps + 1), deflections = new Float64Array(steps + 1);
  const times = [], q = new Float64Array(size * (Math.floor(steps / sample) + 2));
  const energies = [[], [], [], [], []];
  let damped = 0, power = 0, indentation = 0, first = 0, last = 0, done = 0;
  const take = (k) => {
    q.set(u, size * times.length);
    times.push(k * h);
    let kinetic = 0, strain = 0;
    for (let i = 0; i < size; i += 1) { kinetic += M[i] * v[i] * v[i]; strain += K[i] * u[i] * u[i]; }
    const [stored, lost] = law.energy(history, indentation);
    [0.5 * mass * vz * vz, 0.5 * kinetic, 0.5 * strain, stored, lost + damped].forEach((e, i) => energies[i].push(e));
  };
  indentation = z;
  take(0);
  for (let k = 1; k <= steps; k += 1) {
    z += h * vz + (0.5 - beta) * h * h * az;
    vz += (1 - gamma) * h * az;
    let free = z;
    for (let i = 0; i < size; i += 1) {
      u[i] += h * v[i] + (0.5 - beta) * h * h * a[i];
      v[i] += (1 - gamma) * h * a[i];
      d[i] = S[i] === 0 ? 0 : -(C[i] * v[i] + K[i] * u[i]) / S[i];
      free -= p[i] * (u[i] + d[i]);
    }
    const force = contactForce(law, history, free, soft);
    let w = 0, lost = 0;
    for (let i = 0; i < size; i += 1) {
      const change = d[i] + force * X[i];
      u[i] += change;
      a[i] = cm * change;
      v[i] += gamma * h * a[i];
      w += p[i] * u[i];
      lost += C[i] * v[i] * v[i];
    }
    const change = -force / (cm * mass);
    z += change;
    az = cm * change;
    vz += gamma * h * az;
    damped += 0.5 * h * (power + lost);
    power = lost;
    indentation = z - w;
    law.commit(history, indentation);
    forces[k] = law.force(history, indentation)[0];
    deflections[k] = w;
    done = k;
    if (forces[k] !== 0) { first ||= k; last = k; }
    if (k % sample === 0) take(k);
    // As the program has it: the impactor moves away, and has not touched for a while.
    if (untilSeparation && first && vz < 0 && k > last && k - last > 0.05 * (last - first)) break;
  }
  if (done % sample !== 0) take(done);
  return { h, done, forces: forces.subarray(0, done + 1), deflections: deflections.subarray(0, done + 1), times, q, energies };
}
