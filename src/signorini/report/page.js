// SPDX-License-Identifier: BSD-3-Clause
// Charts tell numbers and change steps; bodies in space turn. Everything is on the page without this, but still.
"use strict";

for (const figure of document.querySelectorAll(".chart")) {
  const data = JSON.parse(figure.querySelector("script").textContent);
  const svg = figure.querySelector("svg"), cursor = svg.querySelector(".cursor"), told = figure.querySelector("output");
  const groups = svg.querySelectorAll(".group"), slider = figure.querySelector("input");
  let group = data.groups.length - 1, index = -1;

  const tell = () => {
    const line = data.groups[group].lines[0];
    if (!line || !line.x.length) return;
    index = Math.max(0, Math.min(line.x.length - 1, index));
    const at = line.x[index], share = (at - data.low) / (data.high - data.low);
    cursor.setAttribute("d", `M${data.left + share * (data.right - data.left)} ${data.top}V${data.bottom}`);
    const said = data.groups[group].lines.map((own) => {
      const k = own.x.length === line.x.length ? index : nearest(own.x, at);
      return `${own.name} ${own.y[k] ?? "-"}`;
    });
    told.textContent = `${data.x}: ${at};  ${said.join(";  ")}`;
  };
  const nearest = (values, at) => {
    let best = 0;
    values.forEach((value, k) => { if (Math.abs(value - at) < Math.abs(values[best] - at)) best = k; });
    return best;
  };
  svg.addEventListener("pointermove", (event) => {
    const line = data.groups[group].lines[0], box = svg.getBoundingClientRect();
    if (!line) return;
    const x = (event.clientX - box.left) / box.width * svg.viewBox.baseVal.width;
    index = nearest(line.x, data.low + (x - data.left) / (data.right - data.left) * (data.high - data.low));
    tell();
  });
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    index += step;
    tell();
  });
  if (slider) slider.addEventListener("input", () => {
    group = Number(slider.value);
    groups.forEach((own, k) => { own.toggleAttribute("hidden", k !== group); });
    slider.parentElement.firstChild.textContent = `${data.groups[group].name} `;
    if (index >= 0) tell();
  });
}

for (const figure of document.querySelectorAll(".map")) {
  const data = JSON.parse(figure.querySelector("script").textContent), svg = figure.querySelector("svg");
  const faces = figure.querySelectorAll(".faces path"), cursor = figure.querySelector(".cursor");
  const what = figure.querySelector("select"), slider = figure.querySelector("input");
  const legend = figure.querySelector(".legend"), key = figure.querySelector(".key"), told = figure.querySelector("output");
  let step = data.steps.length - 1, index = -1;

  const tell = () => {
    if (index < 0) return;
    cursor.setAttribute("cx", data.x[index]);
    cursor.setAttribute("cy", data.y[index]);
    const own = data.steps[step], said = data.names.map((name, k) => `${name.split(",")[0]} ${own.values[k][index]}`);
    told.textContent = `${data.at[index]}:  ${said.join(";  ")};  ${data.states[own.status[index]][0]}`;
  };
  const paint = () => {
    const k = Number(what.value), own = data.steps[step], status = k === data.names.length;
    const shade = status ? (ring) => data.states[most(ring.map((node) => own.status[node]))][1] : (ring) => {
      const mean = ring.reduce((sum, node) => sum + own.values[k][node], 0) / ring.length;
      return data.colours[Math.round((data.colours.length - 1) * Math.min(1, Math.max(0, mean / (data.tops[k] || 1))))];
    };
    faces.forEach((path, number) => {
      const face = data.faces[number];
      path.setAttribute("fill", shade(face[2] === face[3] ? face.slice(0, 3) : face));
    });
    key.hidden = status;
    key.firstChild.textContent = `${data.names[k]}: 0 `;
    key.lastChild.textContent = ` ${Number((data.tops[k] ?? 0).toPrecision(4))}`;
    legend.replaceChildren(...(status ? data.states.filter((_, code) => own.status.includes(code)) : []).map(([words, ink]) => {
      const entry = document.createElement("span"), dot = document.createElement("b");
      dot.style.background = ink;
      entry.append(dot, words);
      return entry;
    }));
    if (slider) slider.parentElement.querySelector("span").textContent = own.name;
    tell();
  };
  const most = (codes) => codes.reduce((best, code) =>
    codes.filter((other) => other === code).length >= codes.filter((other) => other === best).length ? code : best);
  const least = (cost) => data.x.reduce((best, _, k) => (cost(k) < cost(best) ? k : best), 0);
  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect(), scale = svg.viewBox.baseVal.width / box.width;
    const x = (event.clientX - box.left) * scale, y = (event.clientY - box.top) * scale;
    index = least((k) => (data.x[k] - x) ** 2 + (data.y[k] - y) ** 2);
    tell();
  });
  svg.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const here = index, at = here < 0 ? [svg.viewBox.baseVal.width / 2, svg.viewBox.baseVal.height / 2] : [data.x[here], data.y[here]];
    const found = least((k) => {
      const right = data.x[k] - at[0], down = data.y[k] - at[1], along = right * way[0] + down * way[1];
      if (here < 0) return right ** 2 + down ** 2;
      return along > 0.5 ? along + 3 * Math.abs(right * way[1] - down * way[0]) : Infinity;
    });
    const ahead = (data.x[found] - at[0]) * way[0] + (data.y[found] - at[1]) * way[1];
    if (here < 0 || ahead > 0.5) index = found;
    tell();
  });
  what.addEventListener("change", paint);
  if (slider) slider.addEventListener("input", () => { step = Number(slider.value); paint(); });
}

for (const table of document.querySelectorAll("main table")) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  if (body.rows.length < 3) continue;
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
      const text = (row) => row.cells[column].textContent;
      const before = (one, two) => {
        const difference = Number(text(one)) - Number(text(two));
        return sign * (Number.isNaN(difference) ? text(one).localeCompare(text(two), "en", { numeric: true }) : difference);
      };
      body.append(...[...body.rows].sort(before));
    });
  });
}

for (const figure of document.querySelectorAll(".scene")) {
  const data = JSON.parse(figure.querySelector("script").textContent), canvas = figure.querySelector("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) { canvas.replaceWith("this browser draws nothing in space; the picture below shows the same"); continue; }
  const bytes = (text) => Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0)).buffer;
  const shader = (kind, text) => {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `#version 300 es
    in vec3 point, moved, colour; uniform mat3 view; uniform float scale, far, zoom, wide, near;
    out vec3 at, tint;
    void main() { at = view * (scale * point + far * moved); tint = colour;
      gl_Position = vec4(zoom * at.x / wide, zoom * at.y, -0.3 * at.z - near, 1.0); }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float; in vec3 at, tint; uniform float edge; out vec4 shade;
    void main() { vec3 n = normalize(cross(dFdx(at), dFdy(at)));
      float light = 0.62 + 0.4 * abs(dot(n, normalize(vec3(-0.4, 0.6, 0.7))));
      shade = vec4(mix(tint * light, vec3(0.08), edge), 1.0); }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  const attribute = (name, values, type, normalised) => {
    const place = gl.getAttribLocation(program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, type, normalised, 0, 0);
  };
  attribute("point", bytes(data.points), gl.SHORT, false);
  attribute("moved", bytes(data.moved), gl.SHORT, false);
  attribute("colour", bytes(data.colours), gl.UNSIGNED_BYTE, true);
  const lists = [data.triangles, data.edges].map((text) => {
    const values = bytes(text), buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, values, gl.STATIC_DRAW);
    return [buffer, values.byteLength / 4];
  });
  const uniform = (name) => gl.getUniformLocation(program, name);
  const slider = figure.querySelector("input");
  let view = data.view.slice(), zoom = 1.0;
  const turn = (right, up) => {
    const [c, s, e, z] = [Math.cos(right), Math.sin(right), Math.cos(up), Math.sin(up)];
    const [x, y, w] = [0, 3, 6].map((k) => view.slice(k, k + 3));
    const a = x.map((v, k) => c * v + s * w[k]), d = w.map((v, k) => c * v - s * x[k]);
    view = [...a, ...y.map((v, k) => e * v - z * d[k]), ...d.map((v, k) => e * v + z * y[k])];
    draw();
  };
  const draw = () => {
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix3fv(uniform("view"), true, view);
    gl.uniform1f(uniform("scale"), data.scale);
    gl.uniform1f(uniform("far"), data.far * Number(slider.value));
    gl.uniform1f(uniform("zoom"), zoom);
    gl.uniform1f(uniform("wide"), canvas.width / canvas.height);
    [[gl.TRIANGLES, 0], [gl.LINES, 1]].forEach(([kind, k]) => {
      gl.uniform1f(uniform("edge"), k);
      gl.uniform1f(uniform("near"), 0.0005 * k);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lists[k][0]);
      gl.drawElements(kind, lists[k][1], gl.UNSIGNED_INT, 0);
    });
  };
  const reset = () => { view = data.view.slice(); zoom = 1.0; draw(); };
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) turn(-0.008 * event.movementX, 0.008 * event.movementY);
  });
  canvas.addEventListener("dblclick", reset);
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    zoom *= Math.exp(-0.001 * event.deltaY);
    draw();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const ways = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (ways[event.key]) { event.preventDefault(); turn(...ways[event.key]); }
    if (event.key === "+" || event.key === "-") { zoom *= event.key === "+" ? 1.15 : 1 / 1.15; draw(); }
    if (event.key === "0") reset();
  });
  slider.addEventListener("input", draw);
  draw();
}
