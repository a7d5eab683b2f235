// On a page that carries three.js, the viewer and a scene: show the scene in root, promise the view.
async function shell(root, options) {
  const text = (id) => document.getElementById(id).textContent;
  const module = (id) => import(URL.createObjectURL(new Blob([text(id)], { type: "text/javascript" })));
  const [library, { viewer }] = await Promise.all([module("three"), module("viewer")]);
  const view = viewer(library, root, options);
  view.replace(JSON.parse(text("scene")));
  return view;
}
