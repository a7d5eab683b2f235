// The 3D view as an element of the studio's page.
import * as library from "nicegui-scene";
import { viewer } from "gridshell-scene/viewer.js";

export default {
  template: `<div class="gs-view"></div>`,
  props: { patterns: String },
  mounted() {
    const pattern = async (mark) => {
      const answer = await fetch(`${this.patterns}?mark=${encodeURIComponent(mark)}`);
      return answer.ok ? answer.text() : null;
    };
    this.view = viewer(library, this.$el, { pattern, chosen: (mark) => this.$emit("chosen", mark) });
    window.view = this.view;
    this.$emit("ready");
  },
  methods: {
    replace(scene, options) { this.view.replace(scene, options); },
    select(mark) { this.view.select(mark); },
  },
};
